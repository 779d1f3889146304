#include "client/input_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdio>
#include <sstream>
#include <thread>

#include "client/error.h"
#include "core/shapes.h"
#include "temp_dir.h"

namespace affskel::client {
namespace {

ExitCode exit_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const ClientError& error) {
    return error.exit_code();
  }
  return ExitCode::kDone;
}

TEST(ReadFile, ReturnsTheBytesOfFilesAndPipes) {
  const TempDir dir;
  std::string bytes(200000, '\0');
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<char>(i * 7);
  spit(dir / "file", bytes);
  EXPECT_EQ(read_file(dir / "file"), bytes);
  ASSERT_EQ(mkfifo((dir / "pipe").c_str(), 0600), 0);
  std::thread writer([&] { spit(dir / "pipe", bytes); });
  EXPECT_EQ(read_file(dir / "pipe"), bytes);
  writer.join();
}

TEST(ReadFile, KeepsToItsLimit) {
  const TempDir dir;
  spit(dir / "file", "12345");
  EXPECT_EQ(read_file(dir / "file", 5), "12345");
  EXPECT_EQ(exit_of([&] { read_file(dir / "file", 4); }), ExitCode::kLimit);
  EXPECT_EQ(exit_of([&] { read_file("/dev/zero", 1000); }), ExitCode::kLimit) << "no size to ask for";
}

// Sanitizers need the address space for themselves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
void limit_memory(rlim_t bytes) {
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_AS, &limit);
}

TEST(ReadFileDeathTest, WithoutMemoryItNamesTheFile) {
  EXPECT_EXIT(
      {
        limit_memory(rlim_t{1} << 30);
        try {
          read_file("/dev/zero");
        } catch (const ClientError& error) {
          std::fprintf(stderr, "%s\n", error.for_people().c_str());
          _exit(static_cast<int>(error.exit_code()));
        }
        _exit(0);
      },
      ::testing::ExitedWithCode(8), "/dev/zero: not enough memory");
}
#endif

TEST(ReadFile, TakesNoMoreThanTheFileNeeds) {
  const TempDir dir;
  spit(dir / "file", std::string(10000000, 'x'));
  EXPECT_LT(read_file(dir / "file").capacity(), 10100000u);
}

TEST(ReadFile, MissingFilesAndDirectoriesAreBadInput) {
  const TempDir dir;
  EXPECT_EQ(exit_of([&] { read_file(dir / "none"); }), ExitCode::kBadInput);
  EXPECT_EQ(exit_of([&] { read_file(dir.path()); }), ExitCode::kBadInput);
}

TEST(CheckSolid, RepairsOnlyWhenAllowedAndTellsIt) {
  const TempDir dir;
  core::Mesh mesh = core::make_tetrahedron(10);
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  spit(dir / "t.off", core::write_off(mesh));
  const InputFile input = read_input(dir / "t.off");
  EXPECT_EQ(exit_of([&] { check_solid(input, false); }), ExitCode::kBadInput);
  std::ostringstream out, err;
  Console console(out, err, {});
  tell_notes(check_solid(input, true), input, console);
  EXPECT_NE(err.str().find("t.off: repaired: "), std::string::npos) << err.str();
}

}  // namespace
}  // namespace affskel::client

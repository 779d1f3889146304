#include "base/find_program.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>

#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::base {
namespace {

void make_program(const std::filesystem::path& file) {
  tests::write_file(file, "");
  ASSERT_EQ(chmod(file.c_str(), 0700), 0);
}

TEST(FindProgramTest, LooksBesideFirst) {
  const tests::TemporaryDirectory beside, other;
  make_program(other / "p");
  EXPECT_EQ(find_program("p", beside.path(), other.path()), other / "p");
  make_program(beside / "p");
  EXPECT_EQ(find_program("p", beside.path(), other.path()), beside / "p");
}

TEST(FindProgramTest, PassesOverWhatIsNone) {
  const tests::TemporaryDirectory empty, folder, text, program;
  std::filesystem::create_directory(folder / "p");
  tests::write_file(text / "p", "");
  const std::string path = empty.path().string() + ":" + folder.path().string() + ":" + text.path().string();
  EXPECT_EQ(find_program("p", "", path), "");
  make_program(program / "p");
  EXPECT_EQ(find_program("p", "", path + ":" + program.path().string()), program / "p");
}

TEST(FindProgramTest, RunsNothingOfTheWorkingDirectory) {
  const tests::TemporaryDirectory dir;
  make_program(dir / "p");
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(dir.path());
  EXPECT_EQ(find_program("p", "", ".::bin"), "");
  std::filesystem::current_path(before);
}

TEST(FindProgramTest, KnowsItsOwnDirectory) {
  EXPECT_TRUE(is_program(own_directory() / "wire_test"));
}

}  // namespace
}  // namespace affskel::base

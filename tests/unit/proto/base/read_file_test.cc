#include "base/read_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>

#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::base {
namespace {

TEST(ReadFileTest, GivesEveryByte) {
  const tests::TemporaryDirectory dir;
  for (const std::size_t size : {0, 1, 15, 16, 5'000'000}) {
    std::string bytes(size, '\0');
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<char>(i * 31 >> 3);
    tests::write_file(dir / "file", bytes);
    EXPECT_TRUE(read_file(dir / "file") == bytes) << size;
  }
}

TEST(ReadFileTest, ReadsAPipeToItsEnd) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  const std::string bytes(60000, 'x');
  ASSERT_EQ(write(ends[1], bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
  close(ends[1]);
  EXPECT_TRUE(read_file("/dev/fd/" + std::to_string(ends[0])) == bytes);
  close(ends[0]);
}

TEST(ReadFileTest, ReadsOneMoreByteThanIsAllowed) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "file", "123456789");
  EXPECT_EQ(read_file(dir / "file", 9), "123456789");
  EXPECT_EQ(read_file(dir / "file", 5), "123456");
  EXPECT_EQ(read_file("/dev/zero", 1000).size(), 1001u);
}

TEST(ReadFileTest, SaysWhatFailed) {
  const tests::TemporaryDirectory dir;
  const auto error_of = [](const std::string& path) {
    try {
      read_file(path);
    } catch (const FileError& error) {
      return error;
    }
    return FileError(0, "", "");
  };
  EXPECT_EQ(error_of(dir / "none").action(), "cannot open");
  EXPECT_EQ(error_of(dir / "none").code().value(), ENOENT);
  EXPECT_EQ(error_of(dir.path()).action(), "cannot read");
  EXPECT_EQ(error_of(dir.path()).code().value(), EISDIR);
}

}  // namespace
}  // namespace affskel::base

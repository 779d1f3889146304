#include "base/regular_file.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <string>

#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::base {
namespace {

TEST(RegularFileTest, NamesWhatIsNone) {
  const tests::TemporaryDirectory dir;
  ASSERT_EQ(mkfifo((dir / "fifo").c_str(), 0600), 0);
  std::filesystem::create_symlink(dir / "fifo", dir / "link");
  EXPECT_STREQ(kind_unless_regular(dir / "fifo"), "a FIFO");
  EXPECT_STREQ(kind_unless_regular(dir / "link"), "a FIFO");
  EXPECT_STREQ(kind_unless_regular(dir.path()), "a directory");
  EXPECT_STREQ(kind_unless_regular("/dev/null"), "a device");
}

TEST(RegularFileTest, IsSilentAboutFilesAndWhatIsNotThere) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "file", "");
  EXPECT_EQ(kind_unless_regular(dir / "file"), nullptr);
  EXPECT_EQ(kind_unless_regular(dir / "none"), nullptr);
}

TEST(RegularFileTest, TakesThePipeOfAShell) {
  std::array<int, 2> ends{};
  ASSERT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
  EXPECT_EQ(kind_unless_regular("/dev/fd/" + std::to_string(ends[0])), nullptr);
  for (const int fd : ends) close(fd);
}

}  // namespace
}  // namespace affskel::base

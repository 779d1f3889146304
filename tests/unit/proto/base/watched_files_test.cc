#include "base/watched_files.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::base {
namespace {

TEST(WatchedFilesTest, TellsEveryChangeOnce) {
  const tests::TemporaryDirectory dir;
  tests::write_file(dir / "one", "1");
  WatchedFiles files({dir / "one", "", dir / "two"});
  EXPECT_FALSE(files.changed());
  tests::write_file(dir / "two", "2");
  EXPECT_TRUE(files.changed()) << "it came";
  EXPECT_FALSE(files.changed());
  std::filesystem::last_write_time(dir / "one",
                                   std::filesystem::last_write_time(dir / "one") + std::chrono::hours(1));
  EXPECT_TRUE(files.changed()) << "it was written";
  const auto time = std::filesystem::last_write_time(dir / "two");
  tests::write_file(dir / "other", "3");
  std::filesystem::last_write_time(dir / "other", time);
  std::filesystem::rename(dir / "other", dir / "two");
  EXPECT_TRUE(files.changed()) << "another is in its place, of the same size and time";
  std::filesystem::remove(dir / "one");
  EXPECT_TRUE(files.changed()) << "it is gone";
  EXPECT_FALSE(files.changed());
}

}  // namespace
}  // namespace affskel::base

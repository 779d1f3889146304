#include "database/disk_reserve.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "tools/temporary_directory.h"

namespace affskel::server {
namespace {

constexpr std::uint64_t kMebi = std::uint64_t{1} << 20;

TEST(DiskReserve, IsRealAndRestoredOnlyWhenThereIsMoreThanWasNotEnough) {
  const tests::TemporaryDirectory directory;
  const std::string file = (directory.path() / "reserve").string();
  std::ofstream(file) << "";
  std::filesystem::resize_file(file, kMebi);  // sparse
  std::uint64_t free = 100 * kMebi;
  DiskReserve reserve(directory.path().string(), kMebi, [&](const std::string&) { return free; });
  EXPECT_TRUE(reserve.whole());
  reserve.release();
  EXPECT_FALSE(std::filesystem::exists(file));
  free = kMebi + kMebi / 4 - 1;
  EXPECT_FALSE(reserve.restore()) << "it would take the last";
  free = 10 * kMebi;
  EXPECT_TRUE(reserve.restore());
  EXPECT_EQ(std::filesystem::file_size(file), kMebi);
  reserve.release();
  EXPECT_FALSE(reserve.restore()) << "as much as before, which was not enough";
  EXPECT_EQ(reserve.wanted(), 11 * kMebi);
  free = 11 * kMebi;
  EXPECT_TRUE(reserve.restore());
  reserve.allow_retry();
  reserve.release();
  EXPECT_TRUE(reserve.restore());
}

}  // namespace
}  // namespace affskel::server

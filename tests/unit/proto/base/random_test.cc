#include "base/random.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace affskel::base {
namespace {

TEST(RandomTest, HexHasTwoDigitsAByteAndEveryDigit) {
  EXPECT_EQ(random_hex(0), "");
  const std::string hex = random_hex(5000);
  EXPECT_EQ(hex.size(), 10000u);
  EXPECT_EQ(std::set<char>(hex.begin(), hex.end()).size(), 16u);
  EXPECT_EQ(hex.find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST(RandomTest, NeverDrawsTheSame) {
  std::set<std::string> drawn;
  for (int i = 0; i < 1000; ++i) drawn.insert(random_hex(16));
  EXPECT_EQ(drawn.size(), 1000u);
}

}  // namespace
}  // namespace affskel::base

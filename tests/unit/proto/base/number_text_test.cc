#include "base/number_text.h"

#include <gtest/gtest.h>

#include <cstdint>

namespace affskel::base {
namespace {

TEST(Rounded, WritesNumbersOfEverydaySizeOut) {
  EXPECT_EQ(rounded(9000, 3), "9000");
  EXPECT_EQ(rounded(8996.4, 3), "9000");
  EXPECT_EQ(rounded(1234567, 3), "1230000");
  EXPECT_EQ(rounded(0.00123456, 3), "0.00123");
  EXPECT_EQ(rounded(-2.5, 3), "-2.5");
  EXPECT_EQ(rounded(0, 3), "0");
  EXPECT_EQ(rounded(3.2e9, 3), "3.2e+09");
  EXPECT_EQ(rounded(1.24e-9, 2), "1.2e-09");
}

TEST(Counted, HasTheRightPlural) {
  EXPECT_EQ(counted(1, "edge"), "1 edge");
  EXPECT_EQ(counted(std::uint64_t{0}, "edge"), "0 edges");
  EXPECT_EQ(counted(2U, "edge"), "2 edges");
  EXPECT_EQ(counted(1, "vertex", "vertices"), "1 vertex");
  EXPECT_EQ(counted(3, "vertex", "vertices"), "3 vertices");
}

}  // namespace
}  // namespace affskel::base

#include "core/erosion/edge_value.h"

#include <gtest/gtest.h>

#include <cmath>

namespace affskel::core {
namespace {

TEST(EdgeValueTest, TangentsCrossWhereTheLinesDo) {
  // 1 + 2 t and 4 - 3 t, which meet at 3/5.
  const EdgeValue x{1, 2}, y{1, -3};
  EXPECT_EQ(tangents_kink(x, y), 5);
  EXPECT_DOUBLE_EQ(tangents_crossing(x, y), 0.6);
  // 2 - t and 1 + t, the minimum's convex counterpart, at 1/2; and 1 + t and 4 + 2 t, at -3.
  EXPECT_EQ(tangents_kink({2, -1}, {2, 1}), -2);
  EXPECT_DOUBLE_EQ(tangents_crossing({2, -1}, {2, 1}), 0.5);
  EXPECT_DOUBLE_EQ(tangents_crossing({1, 1}, {6, 2}), -3);
}

TEST(EdgeValueTest, ParallelTangentsCrossNowhere) {
  EXPECT_EQ(tangents_kink({1, 2}, {5, 2}), 0);
  EXPECT_FALSE(std::isfinite(tangents_crossing({1, 2}, {5, 2})));
  EXPECT_FALSE(std::isfinite(tangents_crossing({1, 2}, {3, 2})));
}

}  // namespace
}  // namespace affskel::core

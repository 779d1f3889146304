#include "core/mesh/coincident_points.h"

#include <gtest/gtest.h>

namespace affskel::core {
namespace {

TEST(SamePlaceTest, NamesTheFirstOfEqualPoints) {
  const std::vector<Vec3> points{{1, 2, 3}, {0, 2, 3}, {1, 2, 3}, {1, 2, 4}, {0, 2, 3}, {1, 2, 3}};
  EXPECT_EQ(first_coincident_point(points), (std::vector<std::uint32_t>{0, 1, 0, 3, 1, 0}));
  EXPECT_TRUE(first_coincident_point({}).empty());
}

TEST(SamePlaceTest, ZeroHasNoSign) {
  const std::vector<Vec3> points{{0.0, -0.0, 5}, {-0.0, -0.0, 5}, {-0.0, 0.0, 5}};
  EXPECT_EQ(first_coincident_point(points), (std::vector<std::uint32_t>{0, 0, 0}));
}

}  // namespace
}  // namespace affskel::core

#include "core/mesh/unused_points.h"

#include <gtest/gtest.h>

namespace affskel::core {
namespace {

TEST(UnusedPointsTest, KeepsTheOthersInTheirOrder) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {5, 0, 0}}, {{4, 1, 2}, {2, 1, 4}}};
  EXPECT_EQ(drop_unused_points(mesh), (std::vector<std::uint32_t>{0, 3, 5}));
  EXPECT_EQ(mesh.points, (std::vector<Vec3>{{1, 0, 0}, {2, 0, 0}, {4, 0, 0}}));
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{2, 0, 1}, {1, 0, 2}}));
  EXPECT_TRUE(drop_unused_points(mesh).empty());
  EXPECT_EQ(mesh.points.size(), 3U);
}

TEST(UnusedPointsTest, WithoutTrianglesNothingIsLeft) {
  Mesh mesh{{{0, 0, 0}, {1, 0, 0}}, {}};
  EXPECT_EQ(drop_unused_points(mesh).size(), 2U);
  EXPECT_TRUE(mesh.points.empty());
}

}  // namespace
}  // namespace affskel::core

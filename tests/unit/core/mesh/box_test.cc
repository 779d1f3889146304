#include "core/mesh/box.h"

#include <gtest/gtest.h>

#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

TEST(Box, HoldsItsPointsTightly) {
  const std::vector<Vec3> points{{1, -2, 3}, {-1, 5, 3.5}, {0, 0, 9}};
  const Box box = box_of(points);
  EXPECT_EQ(box.low, (Vec3{-1, -2, 3}));
  EXPECT_EQ(box.high, (Vec3{1, 5, 9}));
  EXPECT_EQ(box.sides(), (Vec3{2, 7, 6}));
  EXPECT_EQ(box.middle(), (Vec3{0, 1.5, 6}));
  EXPECT_EQ(box.longest_axis(), 1U);
  EXPECT_EQ(box.longest_side(), 7);
}

TEST(Box, OfAMeshLeavesUnusedPointsOut) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 2, 0}, {0, 0, -3}, {50, 50, 50}}, {{0, 1, 2}, {0, 1, 3}}};
  EXPECT_EQ(box_of(mesh).high, (Vec3{1, 2, 0}));
  EXPECT_EQ(box_of(mesh).low, (Vec3{0, 0, -3}));
  EXPECT_EQ(box_of(mesh, mesh.triangles[0]).low, Vec3{});
  EXPECT_EQ(boxes_of(mesh)[1].low, (Vec3{0, 0, -3}));
}

TEST(Box, ByItselfHoldsNothing) {
  Box box;
  EXPECT_FALSE(box.meets(Box{{-1, -1, -1}, {1, 1, 1}}));
  box.include(Vec3{4, 4, 4});
  EXPECT_EQ(box.sides(), Vec3{});
  EXPECT_EQ(box.longest_axis(), 0U);  // of equal sides the first
}

TEST(Box, DiagonalIsThatOfTheUsedVertices) {
  Mesh box = make_box(2, 3, 6);
  EXPECT_EQ(box_diagonal(box), 7);
  box.points.push_back({1000, 0, 0});  // used by nothing
  EXPECT_EQ(box_diagonal(box), 7);
  EXPECT_EQ(box_diagonal({{{0, 0, 0}, {2, 3, 6}}, {}}), 7);
  EXPECT_EQ(box_diagonal({}), 0);
}

}  // namespace
}  // namespace affskel::core

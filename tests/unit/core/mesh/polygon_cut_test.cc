#include "core/mesh/polygon_cut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace affskel::core {
namespace {

// Cuts the polygon over all points in their order.
std::vector<Triangle> cut(const std::vector<Vec3>& points) {
  std::vector<std::uint32_t> corners(points.size());
  std::iota(corners.begin(), corners.end(), 0U);
  std::vector<Triangle> triangles;
  cut_polygon(points, corners, triangles);
  EXPECT_EQ(triangles.size(), points.size() - 2);
  return triangles;
}

// Signed area of each triangle in the xy plane; all positive and of the right sum means no overlap.
void expect_tiling(const std::vector<Vec3>& points, double area) {
  double sum = 0;
  for (const Triangle& t : cut(points)) {
    const double part = 0.5 * cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]).z;
    EXPECT_GT(part, 0);
    sum += part;
  }
  EXPECT_NEAR(sum, area, 1e-11);
}

TEST(CutPolygon, TakesTheShorterDiagonalOfAConvexQuadrilateral) {
  const std::vector<Triangle> triangles = cut({{0, 0, 0}, {1, -0.2, 0}, {4, 0, 0}, {1, 0.2, 0}});
  EXPECT_EQ(triangles[0], (Triangle{0, 1, 3}));
  EXPECT_EQ(triangles[1], (Triangle{1, 2, 3}));
}

TEST(CutPolygon, TakesTheInnerDiagonalOfAReflexQuadrilateral) {
  expect_tiling({{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}, 4);
  expect_tiling({{4, 0, 0}, {1, 1, 0}, {0, 4, 0}, {0, 0, 0}}, 4);
}

TEST(CutPolygon, TilesAStar) {
  expect_tiling({{0, 0, 0}, {2, 1, 0}, {4, 0, 0}, {3, 2, 0}, {4, 4, 0}, {2, 3, 0}, {0, 4, 0}, {1, 2, 0}}, 8);
}

TEST(CutPolygon, TilesAComb) {
  std::vector<Vec3> comb = {{0, 0, 0}, {10, 0, 0}};
  double area = 10;
  for (int i = 4; i >= 0; --i) {
    comb.push_back({2.0 * i + 1.5, 1, 0});
    comb.push_back({2.0 * i + 1, 3, 0});
    comb.push_back({2.0 * i + 0.5, 1, 0});
    area += 1;
  }
  // The row y = 1 between the teeth reaches from x = 0.5 to 9.5; the rest of the base is slanted.
  comb[1] = {9.5, 0, 0};
  comb[0] = {0.5, 0, 0};
  expect_tiling(comb, area - 1);
}

// Exporters write a face with a hole as one ring: round it, over a bridge, round the hole, and back.
TEST(CutPolygon, TilesAFaceWithAHoleWhoseBridgeHasItsEndsTwice) {
  std::vector<Vec3> ring = {{0, 0, 0}, {3, 0, 0}, {3, 3, 0}, {0, 3, 0}, {0, 0, 0},
                            {1, 1, 0}, {1, 2, 0}, {2, 2, 0}, {2, 1, 0}, {1, 1, 0}};
  for (std::size_t first = 0; first < ring.size(); ++first) {
    expect_tiling(ring, 8);
    std::rotate(ring.begin(), ring.begin() + 1, ring.end());
  }
}

TEST(CutPolygon, TilesAGearOfThousandsOfTeeth) {
  std::vector<Vec3> gear;
  for (int i = 0; i < 6000; ++i) {
    const double angle = 2 * M_PI * i / 6000, radius = i % 2 == 0 ? 2.5 : 3;
    gear.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
  }
  expect_tiling(gear, 3000 * 2.5 * 3 * std::sin(2 * M_PI / 6000));
}

}  // namespace
}  // namespace affskel::core

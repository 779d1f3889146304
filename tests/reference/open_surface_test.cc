#include "open_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>

#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::reference {
namespace {

using core::Mesh;
using core::Vec3;

// One triangle, its corners at heights a, b, c.
OpenSurface cut_one(double a, double b, double c) {
  const Mesh mesh{{{0, 0, a}, {1, 0, b}, {0, 1, c}}, {{0, 1, 2}}};
  return cut_and_reconstruct(mesh, {{0, 0, 1}, 0}, 1e-12);
}

double projected_area(const OpenSurface& surface) {
  double sum = 0;
  for (const core::Triangle& t : surface.triangles) {
    const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
    sum += 0.5 * cross(b - a, c - a).z;
  }
  return sum;
}

TEST(OpenSurface, KeepsOrDiscardsWholeTriangles) {
  for (const auto& [a, b, c] : {std::array<double, 3>{-1, -2, -3}, {-1, 0, -1}, {0, 0, -1}, {0, 0, 0}}) {
    EXPECT_EQ(cut_one(a, b, c).triangles.size(), 1U);
    EXPECT_EQ(cut_one(a, b, c).points.size(), 3U);
  }
  for (const auto& [a, b, c] : {std::array<double, 3>{1, 2, 3}, {1, 0, 1}, {0, 0, 1}})
    EXPECT_TRUE(cut_one(a, b, c).triangles.empty());
}

TEST(OpenSurface, ReconstructsCutTriangles) {
  // Areas by the intercept theorem; the whole is 1/2.  All orders of the corners.
  std::array<double, 3> heights = {-1, 1, 1};
  std::sort(heights.begin(), heights.end());
  do {
    const OpenSurface one = cut_one(heights[0], heights[1], heights[2]);
    EXPECT_EQ(one.triangles.size(), 1U);
    EXPECT_NEAR(projected_area(one), 0.5 / 4, 1e-15);
    const OpenSurface two = cut_one(-heights[0], -heights[1], -heights[2]);
    EXPECT_EQ(two.triangles.size(), 2U);
    EXPECT_NEAR(projected_area(two), 0.5 * 3 / 4, 1e-15);
  } while (std::next_permutation(heights.begin(), heights.end()));
  heights = {-1, 0, 1};
  do {
    const OpenSurface through = cut_one(heights[0], heights[1], heights[2]);
    EXPECT_EQ(through.triangles.size(), 1U);
    EXPECT_NEAR(projected_area(through), 0.5 / 2, 1e-15);
  } while (std::next_permutation(heights.begin(), heights.end()));
}

TEST(OpenSurface, FindsComponentsAndTheirVolumes) {
  const Mesh mesh = core::comb(5);
  const OpenSurface below = cut_and_reconstruct(mesh, {{0, 0, 1}, 2}, 1e-12);
  const auto prongs = components(below.triangles);
  ASSERT_EQ(prongs.size(), 5U);
  for (const auto& prong : prongs) EXPECT_NEAR(boundary_integral(below.points, prong, {7, 3, 2}), 2, 1e-13);
  const OpenSurface more = cut_and_reconstruct(mesh, {{0, 0, 1}, 3.5}, 1e-12);
  ASSERT_EQ(components(more.triangles).size(), 1U);
  EXPECT_NEAR(boundary_integral(more.points, more.triangles, {7, 3, 3.5}), 15 + 4.5, 1e-12);
}

TEST(OpenSurface, ContainsWhatLiesUnderTheMissingLid) {
  const Mesh mesh = core::comb(5);
  const Plane plane = {{0, 0, 1}, 2};
  const OpenSurface below = cut_and_reconstruct(mesh, plane, 1e-12);
  const auto prongs = components(below.triangles);
  std::mt19937_64 random(3);
  for (double x = 0.25; x < 9; x += 0.5) {
    // Prongs are [0, 1], [2, 3], ...; also points in the plane itself.
    for (const double z : {0.1, 1.3, 2.0}) {
      const auto holders = std::count_if(prongs.begin(), prongs.end(), [&](const auto& prong) {
        return contains(below.points, prong, {x, 0.4, z}, &plane, random);
      });
      EXPECT_EQ(holders, static_cast<int>(x) % 2 == 0 ? 1 : 0) << x << " " << z;
    }
  }
}

TEST(OpenSurface, ContainsThroughSidesThatAllRaysMayGraze) {
  // Rays from the centre of a box meet the diagonals of its faces often enough.
  const Mesh mesh = core::make_box(1, 1, 1, 8);
  std::mt19937_64 random(5);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_TRUE(contains(mesh.points, mesh.triangles, {0.5, 0.5, 0.5}, nullptr, random));
    EXPECT_FALSE(contains(mesh.points, mesh.triangles, {0.5, 0.5, 1.5}, nullptr, random));
  }
  EXPECT_FALSE(contains(mesh.points, mesh.triangles, mesh.points[0], nullptr, random));
}

TEST(OpenSurface, RaysTellSidesFromInsides) {
  const Vec3 a = {0, 0, 0}, b = {1, 0, 0}, c = {0, 1, 0};
  const auto inside = meet({0.25, 0.25, -2}, {0, 0, 1}, a, b, c);
  ASSERT_TRUE(inside);
  EXPECT_FALSE(inside->grazes);
  EXPECT_EQ(inside->distance, 2);
  const auto side = meet({0.5, 0.5, -2}, {0, 0, 1}, a, b, c);
  ASSERT_TRUE(side);
  EXPECT_TRUE(side->grazes);
  EXPECT_FALSE(meet({0.75, 0.75, -2}, {0, 0, 1}, a, b, c));
  EXPECT_FALSE(meet({0.25, 0.25, 2}, {0, 0, 1}, a, b, c));
}

}  // namespace
}  // namespace affskel::reference

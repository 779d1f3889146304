#include "core/shapes/edge_collapse.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "core/base/error.h"
#include "core/mesh_checks.h"
#include "core/shapes/mirror.h"
#include "core/shapes/shapes.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

Mesh sphere_beyond_the_plane() {
  Mesh mesh = make_sphere(1, 2000);
  for (Vec3& p : mesh.points) p.x += 2;
  return mesh;
}

TEST(EdgeCollapseTest, ReachesTheCountAndKeepsTopologyAndVolume) {
  const Mesh fine = sphere_beyond_the_plane();
  const Mesh coarse = collapse_edges(fine, 300);
  EXPECT_EQ(coarse.triangles.size(), 300u);
  expect_solid_boundary(coarse);
  EXPECT_NEAR(mesh_facts(coarse).volume / mesh_facts(fine).volume, 1, 0.01);
}

TEST(EdgeCollapseTest, ReachesOddAndEvenCountsOfAHalf) {
  const Mesh half = positive_x_half(make_sphere(1, 2000), 0.01);
  for (const std::size_t triangles : {100u, 101u, 150u, 151u}) {
    const Mesh coarse = collapse_edges(half, triangles);
    EXPECT_EQ(coarse.triangles.size(), triangles);
    for (const Vec3& p : coarse.points) EXPECT_GE(p.x, 0);
    const Mesh whole = with_mirror_image(coarse);
    EXPECT_EQ(whole.triangles.size(), 2 * triangles);
    expect_solid_boundary(whole);
  }
}

// A shell so thin that few triangles of one side come through the other.
TEST(EdgeCollapseTest, MakesNoCrossingsWhereNoneAreAllowed) {
  Mesh shell = sphere_beyond_the_plane();
  const auto points = static_cast<std::uint32_t>(shell.points.size());
  const std::size_t triangles = shell.triangles.size();
  for (std::uint32_t v = 0; v < points; ++v)
    shell.points.push_back(Vec3{2, 0, 0} + 0.99 * (shell.points[v] - Vec3{2, 0, 0}));
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto [a, b, c] = shell.triangles[i];
    shell.triangles.push_back({a + points, c + points, b + points});
  }
  ASSERT_TRUE(self_intersections(shell).empty());
  EXPECT_FALSE(self_intersections(collapse_edges(shell, 600)).empty());
  const Mesh coarse = collapse_edges(shell, 600, nullptr, SelfCrossings::kNoNewOnes);
  EXPECT_LT(coarse.triangles.size(), 800U);
  EXPECT_TRUE(self_intersections(coarse).empty());
}

TEST(EdgeCollapseTest, StopsWhereTheTopologyWouldBreak) {
  Mesh box = make_box(1, 1, 1);
  for (Vec3& p : box.points) p.x += 1;
  const Mesh coarse = collapse_edges(box, 2);
  EXPECT_GE(coarse.triangles.size(), 4u);
  expect_solid_boundary(coarse);
}

TEST(EdgeCollapseTest, RefusesAMeshThatIsNotManifold) {
  const Mesh fan{{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {2, 1, 0}, {3, 1, 0}}, {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}}};
  EXPECT_THROW(collapse_edges(fan, 1), CoreError);
  EXPECT_THROW(collapse_edges({fan.points, {{0, 1, 1}}}, 1), CoreError);
  // Two closed surfaces that have a corner in common.
  Mesh touching = make_tetrahedron(1);
  const auto others = static_cast<std::uint32_t>(touching.points.size() - 1);
  const Mesh one = touching;
  for (const Vec3& p : one.points) touching.points.push_back(2.0 * one.points[0] - p);
  for (const auto& [a, b, c] : one.triangles) {
    const auto number = [&](std::uint32_t v) { return v == 0 ? 0 : v + others + 1; };
    touching.triangles.push_back({number(a), number(c), number(b)});
  }
  EXPECT_THROW(collapse_edges(touching, 4), CoreError);
}

}  // namespace
}  // namespace affskel::core

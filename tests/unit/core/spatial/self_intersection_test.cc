#include "core/spatial/self_intersection.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();

Pairs all_crossings(const Mesh& mesh) {
  return self_intersections(mesh, {.max_pairs = kAll});
}

/// Both meshes in one, nothing shared.
Mesh together(const Mesh& a, const Mesh& b) {
  Mesh mesh = a;
  const auto offset = static_cast<std::uint32_t>(a.points.size());
  mesh.points.insert(mesh.points.end(), b.points.begin(), b.points.end());
  for (const Triangle& t : b.triangles) {
    mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return mesh;
}

Mesh shifted(Mesh mesh, const Vec3& by) {
  for (Vec3& p : mesh.points) p = p + by;
  return mesh;
}

TEST(PassThrough, TellsCrossingFromTouching) {
  const Mesh box{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 1}, {2, 1, 1}, {1, 1, 0}, {0, 0, 1}},
                 {{0, 1, 2}, {3, 4, 5}, {6, 4, 5}, {0, 7, 4}, {3, 6, 1}}};
  EXPECT_TRUE(pass_through(box, 0, 1)) << "its edge 3-4 pierces";
  EXPECT_TRUE(pass_through(box, 1, 0));
  EXPECT_FALSE(pass_through(box, 0, 2)) << "a corner in the plane";
  EXPECT_FALSE(pass_through(box, 0, 3)) << "a common corner";
  EXPECT_FALSE(pass_through(box, 0, 0));
}

/// Two triangles, the first in the plane z = 0 over (0,0), (4,0), (0,4).
Mesh with_second(const Vec3& a, const Vec3& b, const Vec3& c) {
  return {{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, a, b, c}, {{0, 1, 2}, {3, 4, 5}}};
}

TEST(SelfIntersectionTest, FindsNoneInCleanShapes) {
  EXPECT_TRUE(all_crossings(make_sphere(1, 20000)).empty());
  EXPECT_TRUE(all_crossings(make_torus(3, 1, 256)).empty());
  EXPECT_TRUE(all_crossings(make_box(1, 2, 3, 6)).empty());
  EXPECT_TRUE(all_crossings(make_cylinder(1, 1, 50)).empty());
  EXPECT_TRUE(all_crossings(Mesh{}).empty());
}

TEST(SelfIntersectionTest, SeesTrianglesThatShareNoVertex) {
  EXPECT_EQ(all_crossings(with_second({1, 1, -1}, {1, 1, 1}, {2, 1, 1})), (Pairs{{0, 1}}));  // pierces
  EXPECT_EQ(all_crossings(with_second({1, 1, 0}, {1, 1, 1}, {2, 1, 1})), (Pairs{{0, 1}}));   // touches inside
  EXPECT_EQ(all_crossings(with_second({4, 0, 0}, {5, 0, 1}, {5, 0, 2})), (Pairs{{0, 1}}));   // equal corner
  EXPECT_EQ(all_crossings(with_second({1, 1, 0}, {8, 1, 0}, {8, 2, 0})), (Pairs{{0, 1}}));   // one plane
  EXPECT_EQ(all_crossings(with_second({1, 1, 0}, {1.5, 1, 0}, {1, 2, 0})), (Pairs{{0, 1}}));  // within
  EXPECT_TRUE(all_crossings(with_second({5, 5, 0}, {6, 5, 0}, {5, 6, 0})).empty());
  EXPECT_TRUE(all_crossings(with_second({3, 3, -1}, {3, 3, 1}, {4, 4, 0})).empty());  // passes by, boxes meet
}

TEST(SelfIntersectionTest, DecidesExactly) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(all_crossings(with_second({1, 1, 0}, {1, 1, 1}, {2, 1, 1})).size(), 1u);
  EXPECT_TRUE(all_crossings(with_second({1, 1, tiny}, {1, 1, 1}, {2, 1, 1})).empty());
  // On the side x + y = 4, one unit in the last place inside of it and outside.
  const double near3 = std::nextafter(3.0, 0.0), far3 = std::nextafter(3.0, 4.0);
  EXPECT_EQ(all_crossings(with_second({1, 3, -1}, {1, 3, 1}, {9, 9, 0})).size(), 1u);
  EXPECT_EQ(all_crossings(with_second({1, near3, -1}, {1, near3, 1}, {9, 9, 0})).size(), 1u);
  EXPECT_TRUE(all_crossings(with_second({1, far3, -1}, {1, far3, 1}, {9, 9, 0})).empty());
}

TEST(SelfIntersectionTest, AllowsWhatASharedVertexExplains) {
  Mesh mesh{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {-1, 0, 1}, {0, -1, 1}}, {{0, 1, 2}, {0, 3, 4}}};
  EXPECT_TRUE(all_crossings(mesh).empty());
  mesh.points[3] = {1, 1, 1};
  mesh.points[4] = {1, 1, -1};  // the opposite side pierces the first triangle
  EXPECT_EQ(all_crossings(mesh), (Pairs{{0, 1}}));
  mesh.points[3] = {9, 9, 0};
  mesh.points[4] = {9, 9, 1};  // a side runs through the first triangle and out of it
  EXPECT_EQ(all_crossings(mesh), (Pairs{{0, 1}}));
}

TEST(SelfIntersectionTest, TellsTheCrossingsInAFanFromItsSharedVertex) {
  Mesh cone = make_cone(3, 6, 2000);  // 2000 triangles round the tip, 2000 round the middle of the base
  EXPECT_TRUE(all_crossings(cone).empty());
  // The rim's first point beyond its third one: what leads to it crosses what lies between, tip and middle
  // alike.
  const std::uint32_t moved_point = 0, beyond = 2;
  const Vec3 step = cone.points[beyond] - cone.points[moved_point];
  cone.points[moved_point] = cone.points[beyond] + 0.25 * step;
  const Pairs pairs = all_crossings(cone);
  EXPECT_FALSE(pairs.empty());
  for (const auto& [i, j] : pairs) {
    const auto leads_there = [&](std::uint32_t t) {
      const Triangle& c = cone.triangles[t];
      return std::find(c.begin(), c.end(), moved_point) != c.end();
    };
    EXPECT_TRUE(leads_there(i) || leads_there(j)) << i << " " << j;
  }
}

TEST(SelfIntersectionTest, SeesTrianglesFoldedOntoEachOther) {
  Mesh mesh{{{0, 0, 0}, {4, 0, 0}, {1, 3, 0}, {2, -1, 0}}, {{0, 1, 2}, {1, 0, 3}}};
  EXPECT_TRUE(all_crossings(mesh).empty());  // flat
  mesh.points[3] = {2, 1, 0};
  EXPECT_EQ(all_crossings(mesh), (Pairs{{0, 1}}));  // folded flat
  mesh.points[3].z = 1e-300;
  EXPECT_TRUE(all_crossings(mesh).empty());  // nearly
}

TEST(SelfIntersectionTest, SeesATriangleGivenTwice) {
  const Mesh mesh{{{0, 0, 0}, {4, 0, 0}, {1, 3, 0}}, {{0, 1, 2}, {1, 2, 0}, {0, 2, 1}}};
  EXPECT_EQ(all_crossings(mesh), (Pairs{{0, 1}, {0, 2}, {1, 2}}));
}

TEST(SelfIntersectionTest, FindsTheSamePairsInAnyOrderOfTriangles) {
  const Mesh mesh = together(make_sphere(1, 500), shifted(make_sphere(1, 500), {0.3, 0.2, 0.1}));
  Mesh reversed = mesh;
  std::reverse(reversed.triangles.begin(), reversed.triangles.end());
  const Pairs pairs = all_crossings(mesh);
  EXPECT_GT(pairs.size(), 50u);
  const auto last = static_cast<std::uint32_t>(mesh.triangles.size() - 1);
  Pairs back;
  for (const auto& [i, j] : all_crossings(reversed)) back.emplace_back(last - j, last - i);
  std::sort(back.begin(), back.end());
  EXPECT_EQ(pairs, back);
}

TEST(SelfIntersectionTest, ReportsTheFirstPairsInOrder) {
  const Mesh mesh = together(make_box(2, 2, 2, 3), shifted(make_box(2, 2, 2, 3), {1, 1, 1}));
  const Pairs pairs = all_crossings(mesh);
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  for (const std::size_t most : {std::size_t{0}, std::size_t{1}, std::size_t{5}}) {
    const Pairs some = self_intersections(mesh, {.max_pairs = most});
    EXPECT_EQ(some, Pairs(pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(most)));
  }
}

TEST(SelfIntersectionTest, IsIndependentOfScale) {
  Mesh mesh = together(make_sphere(1, 100), shifted(make_sphere(1, 100), {0.3, 0.2, 0.1}));
  const Pairs pairs = all_crossings(mesh);
  for (const double scale : {0x1p500, 0x1p-1000}) {
    for (Vec3& p : mesh.points) p = scale * p;
    EXPECT_EQ(all_crossings(mesh), pairs) << scale;
  }
}

TEST(SelfIntersectionTest, ReportsDegenerateTrianglesOnlyAsSuchAndOnRequest) {
  // A point, a needle through triangle 3, and a triangle that names a vertex twice.
  const Mesh mesh{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}, {1, 1, -1}, {1, 1, 0}, {1, 1, 1}, {1, 1, 0}, {1, 1, 0}},
                  {{4, 6, 7}, {3, 4, 5}, {0, 1, 1}, {0, 1, 2}}};
  EXPECT_TRUE(all_crossings(mesh).empty());
}

TEST(SelfIntersectionTest, TakesEdgesOfManyTrianglesAndUnusedVertices) {
  const double nan = std::nan("");
  const Mesh fan{{{nan, nan, nan}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}},
                 {{1, 2, 3}, {1, 2, 4}, {1, 2, 5}}};
  EXPECT_TRUE(all_crossings(fan).empty());
}

TEST(SelfIntersectionTest, RefusesBadMeshes) {
  const Mesh no_vertex{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}}};
  EXPECT_THROW(all_crossings(no_vertex), CoreError);
  const Mesh not_finite{{{0, 0, 0}, {1, 0, 0}, {0, std::numeric_limits<double>::infinity(), 0}}, {{0, 1, 2}}};
  EXPECT_THROW(all_crossings(not_finite), CoreError);
}

}  // namespace
}  // namespace affskel::core

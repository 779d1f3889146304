#include "core/spatial/axis_rays.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/mesh_checks.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// The triangle that the ray meets first, in general position, by trying all of them.
std::uint32_t brute_force(const Mesh& mesh, const Vec3& q, const Vec3& way) {
  double nearest = 1e300;
  std::uint32_t best = kNone;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const auto& [i, j, k] = mesh.triangles[t];
    const Vec3 &a = mesh.points[i], &b = mesh.points[j], &c = mesh.points[k];
    const Vec3 n = cross(b - a, c - a);
    const double s = dot(a - q, n) / dot(way, n);
    const Vec3 x = q + s * way;
    const bool in =
        dot(cross(b - a, x - a), n) > 0 && dot(cross(c - b, x - b), n) > 0 && dot(cross(a - c, x - c), n) > 0;
    if (!(s > 0) || !in || s >= nearest) continue;
    nearest = s;
    best = t;
  }
  return best;
}

TEST(AxisRays, FindWhatBruteForceFinds) {
  for (const Mesh& mesh : {hollow_ball(), cup(16), shaken(make_torus(2, 0.7, 512), 0.01, 3)}) {
    const AxisRays rays(mesh);
    std::mt19937_64 random(23);
    std::uniform_real_distribution<double> coordinate(-3, 3);
    int hits = 0;
    for (int n = 0; n < 300; ++n) {
      const Vec3 q{coordinate(random), coordinate(random), coordinate(random)};
      for (int axis = 0; axis < 3; ++axis) {
        for (const double sense : {-1.0, 1.0}) {
          const Vec3 way{axis == 0 ? sense : 0, axis == 1 ? sense : 0, axis == 2 ? sense : 0};
          const AxisRays::Hit hit = rays.shoot(q, axis, sense > 0);
          EXPECT_EQ(hit.triangle, brute_force(mesh, q, way));
          EXPECT_EQ(hit.winding, std::lround(winding_number(mesh, q)));
          hits += hit.triangle != kNone;
        }
      }
    }
    EXPECT_GT(hits, 300);
  }
}

// Rays through vertices and along edges of the box still leave it once.
TEST(AxisRays, CrossAnEdgeOnce) {
  const Mesh box = make_box(4, 4, 4, 4);
  const AxisRays rays(box);
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool upward : {false, true}) {
      for (const Vec3& q : {Vec3{2, 2, 2}, {1, 1, 1}, {1.5, 1.5, 1.5}, {0.5, 3, 1}}) {
        const AxisRays::Hit hit = rays.shoot(q, axis, upward);
        EXPECT_EQ(hit.winding, 1);
        EXPECT_NE(hit.triangle, kNone);
      }
    }
  }
}

}  // namespace
}  // namespace affskel::core

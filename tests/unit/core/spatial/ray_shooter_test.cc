#include "core/spatial/ray_shooter.h"

#include <gtest/gtest.h>

#include "core/erosion/directions.h"
#include "core/solid/solid.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Least s at which the ray leaves through a triangle not at the vertex, by trying all of them.
double brute_force(const Mesh& mesh, std::uint32_t vertex, const Vec3& d, std::uint32_t& best) {
  double best_s = 1e300;
  best = kNone;
  const Vec3 o = mesh.points[vertex];
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& c = mesh.triangles[t];
    if (c[0] == vertex || c[1] == vertex || c[2] == vertex) continue;
    const Vec3 &p = mesh.points[c[0]], &q = mesh.points[c[1]], &r = mesh.points[c[2]];
    const Vec3 n = cross(q - p, r - p);
    if (!(dot(n, d) < 0)) continue;
    const double s = dot(o - p, n) / dot(d, n);
    const Vec3 x = o - s * d;
    const bool in = dot(cross(q - p, x - p), n) >= 0 && dot(cross(r - q, x - q), n) >= 0 &&
                    dot(cross(p - r, x - r), n) >= 0;
    if (s < 0 || !in || s >= best_s) continue;
    best_s = s;
    best = t;
  }
  return best_s;
}

TEST(RayShooter, FindsWhatBruteForceFinds) {
  const Mesh mesh = make_solid(hollow_ball()).mesh;
  const RayShooter rays(mesh);
  std::size_t hits = 0;
  for (const Vec3& d : make_directions(make_solid(mesh), "random:10:5")) {
    for (std::uint32_t v = 0; v < mesh.points.size(); v += 7) {
      std::uint32_t expected = 0;
      brute_force(mesh, v, d, expected);
      EXPECT_EQ(rays.first_exit_below(v, d, [](std::uint32_t) { return true; }), expected);
      hits += expected != kNone;
    }
  }
  EXPECT_GT(hits, 100U);
}

TEST(RayShooter, LeavesOutWhatIsNotAccepted) {
  const Mesh mesh = make_solid(hollow_ball()).mesh;
  const RayShooter rays(mesh);
  const Vec3 d{0.6, 0, 0.8};
  std::uint32_t first = kNone, vertex = 0;
  for (; first == kNone; ++vertex) {
    first = rays.first_exit_below(vertex, d, [](std::uint32_t) { return true; });
  }
  --vertex;
  EXPECT_NE(rays.first_exit_below(vertex, d, [&](std::uint32_t t) { return t != first; }), first);
}

}  // namespace
}  // namespace affskel::core

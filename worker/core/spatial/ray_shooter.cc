#include "core/spatial/ray_shooter.h"

#include <limits>

namespace affskel::core {
namespace {

constexpr double kMissed = std::numeric_limits<double>::infinity();

// The parameter s at which o + s r meets triangle abc, or infinity.  Moeller & Trumbore (1997), borders
// included.
double hit(const Vec3& o, const Vec3& r, const Vec3& a, const Vec3& b, const Vec3& c, double slack) {
  const Vec3 e = b - a, f = c - a;
  const Vec3 p = cross(r, f);
  const double det = dot(e, p);
  if (det == 0) return kMissed;
  const Vec3 q = o - a;
  const double u = dot(q, p) / det;
  const Vec3 w = cross(q, e);
  const double v = dot(r, w) / det;
  if (!(u >= -slack && v >= -slack && u + v <= 1 + slack)) return kMissed;
  return dot(f, w) / det;
}

}  // namespace

RayShooter::RayShooter(const Mesh& mesh, unsigned threads) : mesh_(mesh), tree_(boxes_of(mesh), threads) {}

std::uint32_t RayShooter::first_exit_below(std::uint32_t vertex, const Vec3& d,
                                           const std::function<bool(std::uint32_t)>& accept) const {
  for (const double slack : {1e-12, 1e-9, 1e-6}) {
    WayQuery ray{mesh_.points[vertex], -d, slack, kMissed};  // up to the nearest hit so far
    std::uint32_t nearest = kNone;
    tree_.visit(ray, [&](std::uint32_t t) {
      const Triangle& corner = mesh_.triangles[t];
      if (uses(corner, vertex) || !accept(t) || !(dot(twice_area(mesh_, corner), d) < 0)) return;
      const Vec3 &a = mesh_.points[corner[0]], &b = mesh_.points[corner[1]], &c = mesh_.points[corner[2]];
      const double s = hit(ray.from, ray.way, a, b, c, slack);
      if (s < 0 || s == kMissed || s > ray.last || (s == ray.last && t > nearest)) return;
      nearest = t;
      ray.last = s;
    });
    if (nearest != kNone) return nearest;
  }
  return kNone;
}

}  // namespace affskel::core

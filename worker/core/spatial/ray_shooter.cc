#include "core/spatial/ray_shooter.h"

#include <algorithm>
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

// The ray origin + s ray as far as it is of interest: up to the nearest hit so far.
struct Ray {
  Vec3 origin, ray;
  double slack;
  double nearest_s = kMissed;
  std::uint32_t nearest = RayShooter::kNone;

  // Whether the ray may meet something in the box before the nearest hit, or at it.
  bool meets(const Box& box) const {
    double near = 0, far = nearest_s;
    for (int k = 0; k < 3; ++k) {
      const double low = box.low[static_cast<std::size_t>(k)] - slack - origin[k];
      const double high = box.high[static_cast<std::size_t>(k)] + slack - origin[k];
      if (ray[k] == 0) {
        if (low > 0 || high < 0) return false;
        continue;
      }
      const double a = low / ray[k], b = high / ray[k];
      near = std::max(near, std::min(a, b));
      far = std::min(far, std::max(a, b));
    }
    return !(near > far);
  }

  void take(double s, std::uint32_t triangle) {
    if (s < 0 || s == kMissed || s > nearest_s || (s == nearest_s && triangle > nearest)) return;
    nearest = triangle;
    nearest_s = s;
  }
};

}  // namespace

RayShooter::RayShooter(const Mesh& mesh, unsigned threads) : mesh_(mesh), tree_(boxes_of(mesh), threads) {}

std::uint32_t RayShooter::first_exit_below(std::uint32_t vertex, const Vec3& d,
                                           const std::function<bool(std::uint32_t)>& accept) const {
  for (const double slack : {1e-12, 1e-9, 1e-6}) {
    Ray ray{mesh_.points[vertex], -d, slack};
    tree_.visit(ray, [&](std::uint32_t t) {
      const Triangle& corner = mesh_.triangles[t];
      if (uses(corner, vertex) || !accept(t)) return;
      const Vec3 &a = mesh_.points[corner[0]], &b = mesh_.points[corner[1]], &c = mesh_.points[corner[2]];
      if (dot(twice_area(mesh_, corner), d) < 0) ray.take(hit(ray.origin, ray.ray, a, b, c, slack), t);
    });
    if (ray.nearest != kNone) return ray.nearest;
  }
  return kNone;
}

}  // namespace affskel::core

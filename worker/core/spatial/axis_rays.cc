#include "core/spatial/axis_rays.h"

#include <limits>

#include "core/spatial/ray_crossing.h"

namespace affskel::core {

AxisRays::AxisRays(const Mesh& mesh, unsigned threads) : mesh_(mesh), tree_(boxes_of(mesh), threads) {}

// A ray along the axis that leaves the solid through a triangle sees it wind counter-clockwise.
AxisRays::Hit AxisRays::shoot(const Vec3& q, int axis, bool upward) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  Box ray{q, q};
  (upward ? ray.high : ray.low)[axis] = upward ? kFar : -kFar;
  Hit hit;
  double nearest = kFar;
  tree_.visit(ray, [&](std::uint32_t index) {
    const Triangle& t = mesh_.triangles[index];
    const int round = winding_round_line(mesh_, t, q, axis);
    if (round == 0) return;
    const double along = distance_along(mesh_, t, q, axis), distance = upward ? along : -along;
    if (!(distance > 0)) return;
    hit.winding += upward ? round : -round;
    if (distance > nearest || (distance == nearest && index > hit.triangle)) return;
    nearest = distance;
    hit.triangle = index;
  });
  return hit;
}

}  // namespace affskel::core

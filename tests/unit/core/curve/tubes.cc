#include "core/curve/tubes.h"

#include <algorithm>
#include <cmath>

#include "core/mesh/box.h"
#include "core/shapes/implicit_mesh.h"

namespace affskel::core {
namespace {

Box box_round(const Tube& tube) {
  Box box;
  const Vec3 r{tube.radius, tube.radius, tube.radius};
  for (const Vec3& end : {tube.from, tube.to}) {
    box.include(end - r);
    box.include(end + r);
  }
  return box;
}

}  // namespace

double Tube::distance(const Vec3& p) const {
  const Vec3 along = to - from;
  const double t = std::clamp(dot(p - from, along) / dot(along, along), 0.0, 1.0);
  return norm(p - from - t * along) - radius;
}

Mesh tube_mesh(std::span<const Tube> tubes, double edge) {
  Box box;
  for (const Tube& tube : tubes) box.include(box_round(tube));
  const ImplicitFunction f = [&](const Vec3& p) {
    double least = HUGE_VAL;
    for (const Tube& tube : tubes) least = std::min(least, tube.distance(p));
    return least;
  };
  const Vec3 margin{2 * edge, 2 * edge, 2 * edge};
  Mesh mesh = mesh_zero_set(f, {box.low - margin, box.high + margin, edge});
  fair_onto(f, 0.01 * edge, 3, mesh);
  return mesh;
}

double volume_where(const Tube& tube, const std::function<bool(const Vec3&)>& where) {
  const double step = tube.radius / 25;
  const Box box = box_round(tube);
  double count = 0;
  for (double x = box.low[0] + 0.3 * step; x < box.high[0]; x += step)
    for (double y = box.low[1] + 0.4 * step; y < box.high[1]; y += step)
      for (double z = box.low[2] + 0.6 * step; z < box.high[2]; z += step)
        count += tube.contains({x, y, z}) && where({x, y, z});
  return count * step * step * step;
}

Vec3 turned(const Vec3& p) {
  constexpr double kCos = 0.8, kSin = 0.6;
  const Vec3 q{kCos * p.x - kSin * p.y, kSin * p.x + kCos * p.y, p.z};
  constexpr double kOther = 12.0 / 13, kRest = 5.0 / 13;
  return {q.x, kOther * q.y - kRest * q.z, kRest * q.y + kOther * q.z};
}

}  // namespace affskel::core

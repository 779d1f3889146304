#include "core/solid/solid_membership.h"

#include <limits>

#include "core/spatial/ray_crossing.h"

namespace affskel::core {
SolidMembership::SolidMembership(const Mesh& mesh) : mesh_(mesh), tree_(boxes_of(mesh)) {}

bool SolidMembership::contains(const Vec3& q, double tolerance) const {
  if (winding_number(q) > 0) return true;
  if (!(tolerance > 0)) return false;
  for (const double x : {-tolerance, tolerance}) {
    for (const double y : {-tolerance, tolerance}) {
      for (const double z : {-tolerance, tolerance}) {
        if (winding_number(q + Vec3{x, y, z}) > 0) return true;
      }
    }
  }
  return false;
}

// A ray that leaves the solid through a triangle sees it wind counter-clockwise.
int SolidMembership::winding_number(const Vec3& q) const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  int winding = 0;
  tree_.visit({{q.x, q.y, q.z}, {kFar, q.y, q.z}}, [&](std::uint32_t index) {
    const Triangle& t = mesh_.triangles[index];
    const int round = winding_round_line(mesh_, t, q, 0);
    if (round != 0 && distance_along(mesh_, t, q, 0) > 0) winding += round;
  });
  return winding;
}

}  // namespace affskel::core

#include "core/solid/solid_membership.h"

namespace affskel::core {
SolidMembership::SolidMembership(const Mesh& mesh) : rays_(mesh) {}

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

}  // namespace affskel::core

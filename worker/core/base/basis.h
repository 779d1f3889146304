#pragma once

#include <cmath>

#include "core/base/unit.h"
#include "core/base/vec3.h"

namespace affskel::core {

/// Two unit vectors u and w that form a right-handed basis with the unit vector d (Duff et al. 2017).
inline void make_basis(const Vec3& d, Vec3& u, Vec3& w) {
  const double sign = d.z >= 0 ? 1 : -1;
  const double s = -1 / (sign + d.z), m = d.x * d.y * s;
  u = {1 + sign * d.x * d.x * s, sign * m, -sign * d.x};
  w = {m, sign + d.y * d.y * s, -d.y};
}

/// A unit vector at right angles to a unit vector; of its mirror image along an axis the mirror image, or its opposite.
inline Vec3 unit_beside(const Vec3& d) {
  const Vec3 axis = std::abs(d.x) <= std::abs(d.y) && std::abs(d.x) <= std::abs(d.z) ? Vec3{1, 0, 0}
                    : std::abs(d.y) <= std::abs(d.z)                                 ? Vec3{0, 1, 0}
                                                                                     : Vec3{0, 0, 1};
  return unit(cross(d, axis));
}

}  // namespace affskel::core

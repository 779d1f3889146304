#pragma once

#include "core/base/vec3.h"

namespace affskel::core {

/// Two unit vectors u and w that form a right-handed basis with the unit vector d (Duff et al. 2017).
inline void make_basis(const Vec3& d, Vec3& u, Vec3& w) {
  const double sign = d.z >= 0 ? 1 : -1;
  const double s = -1 / (sign + d.z), m = d.x * d.y * s;
  u = {1 + sign * d.x * d.x * s, sign * m, -sign * d.x};
  w = {m, sign + d.y * d.y * s, -d.y};
}

}  // namespace affskel::core

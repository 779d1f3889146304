#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/matrix3.h"
#include "core/base/unit.h"

namespace affskel::core {

// Where a solid's symmetry leaves its axes open, the coordinate axes of the mesh decide.

/// Values that differ by less than this share of the largest count as equal, smaller ones as 0.
inline constexpr double kAxisTie = 1e-6;

/// Gram and Schmidt's: the first column keeps its direction, the second its plane with the first, and the
/// third makes them right-handed.  The first two are not parallel.
inline Matrix3 orthonormal(const Matrix3& axes) {
  const Vec3 first = unit(axes[0]), second = unit(axes[1] - dot(axes[1], first) * first);
  return {first, second, cross(first, second)};
}

/// Orthonormal axes of the plane across `normal` (a unit vector): the first is the projection of the
/// coordinate axis that is nearest to the plane (x before y before z), the second makes normal, first and
/// second right-handed.
inline std::array<Vec3, 2> plane_axes(const Vec3& normal) {
  const std::array<double, 3> away = {std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)};
  const double least = *std::min_element(away.begin(), away.end());
  std::size_t nearest = 0;
  while (away[nearest] > least + kAxisTie) ++nearest;
  const Vec3& axis = kIdentity3[nearest];
  const Vec3 first = unit(axis - dot(axis, normal) * normal);
  return {first, unit(cross(normal, first))};
}

}  // namespace affskel::core

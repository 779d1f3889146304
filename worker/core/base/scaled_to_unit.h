#pragma once

#include <algorithm>
#include <cmath>

#include "core/base/vec3.h"

namespace affskel::core {

/// The exponent of a vector's largest component, 0 for the zero vector: v = 2^exponent scaled_to_unit(v).
inline int largest_exponent(const Vec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  return largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
}

/// The vector times the power of two that brings its largest component to [1, 2): an exact step, before
/// squares that would leave the range of a double are taken.  Gradients of E are areas: at coordinates of
/// 1e80 their squares are 1e320.  Unit vectors and angles come out the same to the last bit.
inline Vec3 scaled_to_unit(const Vec3& v) {
  const int e = -largest_exponent(v);
  return {std::ldexp(v.x, e), std::ldexp(v.y, e), std::ldexp(v.z, e)};
}

}  // namespace affskel::core

#pragma once

#include <cmath>

#include "core/base/vec3.h"

namespace affskel::core {

// Lengths of vectors of any size.  Gradients of E are areas: at coordinates of 1e80 their squares are 1e320,
// beyond the range of a double.  Scaled by a power of two, an exact step, all comes out the same to the last
// bit.

/// The exponent of a vector's largest component, 0 for the zero vector: v = 2^exponent scaled_to_unit(v).
inline int largest_exponent(const Vec3& v) {
  const double largest = largest_component(v);
  return largest > 0 && std::isfinite(largest) ? std::ilogb(largest) : 0;
}

/// The vector times the power of two that brings its largest component to [1, 2).
inline Vec3 scaled_to_unit(const Vec3& v) {
  const int e = -largest_exponent(v);
  return {std::ldexp(v.x, e), std::ldexp(v.y, e), std::ldexp(v.z, e)};
}

/// |v|.
inline double length_of(const Vec3& v) {
  return std::ldexp(norm(scaled_to_unit(v)), largest_exponent(v));
}

/// v / |v|; 0 for the zero vector.
inline Vec3 unit(const Vec3& v) {
  const Vec3 near = scaled_to_unit(v);
  const double length = norm(near);
  return length > 0 ? (1 / length) * near : Vec3{};
}

}  // namespace affskel::core

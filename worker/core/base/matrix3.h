#pragma once

#include <array>

#include "core/base/vec3.h"

namespace affskel::core {

/// A 3x3 matrix, column by column.
using Matrix3 = std::array<Vec3, 3>;

inline constexpr Matrix3 kIdentity3 = {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

inline Vec3 operator*(const Matrix3& m, const Vec3& v) {
  return v.x * m[0] + (v.y * m[1] + v.z * m[2]);
}
inline Matrix3 operator*(const Matrix3& a, const Matrix3& b) {
  return {a * b[0], a * b[1], a * b[2]};
}
inline Matrix3 operator+(const Matrix3& a, const Matrix3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Matrix3 operator*(double s, const Matrix3& m) {
  return {s * m[0], s * m[1], s * m[2]};
}

/// a b^T.
inline Matrix3 outer(const Vec3& a, const Vec3& b) {
  return {b.x * a, b.y * a, b.z * a};
}

/// m^T v.
inline Vec3 transposed_times(const Matrix3& m, const Vec3& v) {
  return {dot(m[0], v), dot(m[1], v), dot(m[2], v)};
}

inline double determinant(const Matrix3& m) {
  return dot(m[0], cross(m[1], m[2]));
}

/// m^-T: what maps normals as m maps points, and whose columns are the rows of m^-1.  m is not singular.
inline Matrix3 inverse_transposed(const Matrix3& m) {
  return (1 / determinant(m)) * Matrix3{cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])};
}

}  // namespace affskel::core

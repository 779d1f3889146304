#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>

namespace affskel::core {

/// A point or vector of R^3.
struct Vec3 {
  double x = 0;
  double y = 0;
  double z = 0;

  double operator[](std::integral auto k) const { return k == 0 ? x : k == 1 ? y : z; }
  double& operator[](std::integral auto k) { return k == 0 ? x : k == 1 ? y : z; }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

template <class Number>
Vec3 vector_of(const std::array<Number, 3>& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

inline Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vec3 operator-(const Vec3& a) {
  return {-a.x, -a.y, -a.z};
}
inline Vec3 operator*(double s, const Vec3& a) {
  return {s * a.x, s * a.y, s * a.z};
}
inline Vec3 operator/(const Vec3& a, double s) {
  return {a.x / s, a.y / s, a.z / s};
}
inline double dot(const Vec3& a, const Vec3& b) {
  return (a.x * b.x + a.y * b.y) + a.z * b.z;
}
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
/// Whether all components are.
inline bool is_finite(const Vec3& a) {
  return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// The magnitude of the largest component.
inline double largest_component(const Vec3& a) {
  return std::max({std::abs(a.x), std::abs(a.y), std::abs(a.z)});
}

inline double norm(const Vec3& a) {
  return std::sqrt(dot(a, a));
}

inline double squared_distance(const Vec3& a, const Vec3& b) {
  const Vec3 way = a - b;
  return dot(way, way);
}

}  // namespace affskel::core

#include "core/base/affine_map.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/plain_math.h"

namespace affskel::core {
namespace {

// Of magnitude about 1 whatever the unit, so that products of three do not overflow.
std::array<Vec3, 3> scaled_rows(const AffineMap& map, double& unit) {
  unit = 0;
  for (const Vec3& row : map.rows) unit = std::max(unit, largest_component(row));
  int exponent = 0;
  std::frexp(unit, &exponent);
  unit = std::ldexp(1.0, exponent);
  std::array<Vec3, 3> rows = map.rows;
  for (Vec3& row : rows) row = row / unit;
  return rows;
}

double triple(const std::array<Vec3, 3>& rows) {
  return dot(rows[0], cross(rows[1], rows[2]));
}

std::array<Vec3, 3> cofactors(const std::array<Vec3, 3>& rows) {
  return {cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])};
}

}  // namespace

AffineMap scaling(double x, double y, double z) {
  return {.rows = {Vec3{x, 0, 0}, Vec3{0, y, 0}, Vec3{0, 0, z}}};
}

AffineMap translation(const Vec3& shift) {
  return {.shift = shift};
}

AffineMap rotation(int axis, double degrees) {
  const auto [sine, cosine] = plain_sin_cos_degrees(degrees);
  const auto u = static_cast<std::size_t>((axis + 1) % 3), v = static_cast<std::size_t>((axis + 2) % 3);
  AffineMap map;
  map.rows[u][u] = map.rows[v][v] = cosine;
  map.rows[u][v] = -sine;
  map.rows[v][u] = sine;
  return map;
}

AffineMap shear(int to, int from, double factor) {
  AffineMap map;
  map.rows[static_cast<std::size_t>(to)][from] = factor;
  return map;
}

AffineMap then(const AffineMap& first, const AffineMap& second) {
  AffineMap both;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3& row = second.rows[i];
    both.rows[i] = row.x * first.rows[0] + row.y * first.rows[1] + row.z * first.rows[2];
  }
  both.shift = second(first.shift);
  return both;
}

double determinant(const AffineMap& map) {
  double unit = 0;
  const double scaled = triple(scaled_rows(map, unit));
  return ((scaled * unit) * unit) * unit;
}

bool is_singular(const AffineMap& map) {
  for (const Vec3& row : map.rows) {
    if (!is_finite(row)) return true;
  }
  if (!is_finite(map.shift)) return true;
  const double det = determinant(map);
  if (!std::isnormal(det)) return true;
  double unit = 0;
  const std::array<Vec3, 3> rows = scaled_rows(map, unit);
  return std::abs(triple(rows)) < 1e-12 * norm(rows[0]) * norm(rows[1]) * norm(rows[2]);
}

void require_regular(const AffineMap& map) {
  if (is_singular(map)) {
    refuse("the map is singular or out of range: it has no inverse");
  }
}

AffineMap inverse(const AffineMap& map) {
  require_regular(map);
  double unit = 0;
  const std::array<Vec3, 3> rows = scaled_rows(map, unit);
  const std::array<Vec3, 3> c = cofactors(rows);
  const double det = dot(rows[0], c[0]);
  AffineMap result;
  for (std::size_t i = 0; i < 3; ++i) {
    // The cofactors, transposed; adding 0 turns a negative zero into a plain one.
    result.rows[i] = Vec3{c[0][i] / det / unit, c[1][i] / det / unit, c[2][i] / det / unit} + Vec3{};
  }
  result.shift = Vec3{} - result(map.shift);  // the shift is 0 up to here
  return result;
}

NormalMap::NormalMap(const AffineMap& map) {
  require_regular(map);
  double unit = 0;
  const std::array<Vec3, 3> rows = scaled_rows(map, unit);
  cofactors_ = cofactors(rows);
  turned_ = triple(rows) < 0;
  identity_ = map.rows == AffineMap{}.rows;
}

Vec3 NormalMap::operator()(const Vec3& n) const {
  if (identity_) return n;
  const Vec3 mapped = {dot(cofactors_[0], n), dot(cofactors_[1], n), dot(cofactors_[2], n)};
  // Scaled first: squares of tiny or huge vectors would leave the range.
  const double big = largest_component(mapped);
  if (!(big > 0)) return {};
  const Vec3 w = mapped / big;
  // Adding 0 turns a negative zero into a plain one.
  return w / (turned_ ? -norm(w) : norm(w)) + Vec3{};
}

}  // namespace affskel::core

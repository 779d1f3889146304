#include "core/erosion/frame_field.h"

#include <cmath>
#include <numbers>

#include "core/base/plain_math.h"
#include "core/base/unit.h"
#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {
Matrix3 frame_matrix(const Lattice& lattice) {
  const Matrix3& axes = lattice.grid.axes;
  if (is_cubic(lattice.grid)) return kIdentity3;
  const double step = cube_root(std::abs(determinant(axes)));
  return (1 / step) * axes;
}

DirectionSet frame_directions(const Lattice& lattice, const DirectionSet& directions) {
  const Matrix3 f = frame_matrix(lattice);
  if (f == kIdentity3) return directions;
  DirectionSet result;
  result.reserve(directions.size());
  for (const Vec3& d : directions) {
    result.push_back(unit(transposed_times(f, d)));
  }
  return result;
}

double section_area(const Matrix3& to_mesh, const Vec3& gradient) {
  return std::ldexp(norm(to_mesh * scaled_to_unit(gradient)), largest_exponent(gradient));
}

std::vector<float> section_radii(const FrameField& field) {
  std::vector<float> radii;
  radii.reserve(field.gradient.size());
  for (const Vec3& gradient : field.gradient)
    radii.push_back(static_cast<float>(std::sqrt(norm(gradient) / std::numbers::pi) / field.spacing));
  return radii;
}

FrameField frame_field(const Lattice& lattice, const DirectionSet& directions,
                       std::span<const FieldValue> values) {
  const Matrix3 f = frame_matrix(lattice);
  FrameField result;
  result.spacing = lattice.spacing;
  result.erosion.reserve(values.size());
  result.gradient.reserve(values.size());
  result.direction.reserve(values.size());
  for (const FieldValue& value : values) {
    const bool known = value.direction != FieldValue::kNoDirection;
    result.erosion.push_back(value.erosion);
    result.gradient.push_back(known ? value.area * transposed_times(f, directions[value.direction]) : Vec3{});
    result.direction.push_back(value.direction);
  }
  return result;
}

}  // namespace affskel::core

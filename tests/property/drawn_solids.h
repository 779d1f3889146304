#pragma once

#include <rapidcheck.h>

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/erosion/erosion.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::property {

/// Random small solids and their fields, for the properties.  The draw_ functions take their values from
/// rapidcheck, which reports and shrinks them: call them inside a property only.

/// Uniform in low .. high - 1 whatever rapidcheck's size is: the first cases are no smaller than the last.
template <typename T>
T draw_in(T low, T high) {
  return *rc::gen::resize(rc::kNominalSize, rc::gen::inRange(low, high));
}

/// A torus, ellipsoid, box, cone, hollow ball, cup, comb or body with random sizes, up to some 200 triangles.
core::Mesh draw_solid();

/// The same, bent so that no symmetry is left: its moments determine its affine frame.
core::Mesh draw_crooked_solid();

/// About `points` sample points in an axis-parallel lattice with a random offset, so that no point keeps to
/// the solid's planes of symmetry.  In mesh units, unlike the core's own frames.
core::LatticeGrid draw_grid(const core::Mesh& mesh, double points = 150);

/// A random order of 0 .. count - 1.
std::vector<std::uint32_t> draw_order(std::size_t count);

/// y -> rows . y + shift.
struct AffineMap {
  std::array<core::Vec3, 3> rows;
  core::Vec3 shift;

  core::Vec3 vector(const core::Vec3& v) const { return {dot(rows[0], v), dot(rows[1], v), dot(rows[2], v)}; }
  core::Vec3 point(const core::Vec3& p) const { return vector(p) + shift; }
  core::Mesh mesh(core::Mesh m) const;
  core::LatticeGrid grid(const core::LatticeGrid& f) const;
};

/// Determinant 1 to rounding: shears by up to 1 and stretches between 1/2 and 2 along each axis.
AffineMap draw_unimodular_map();

/// A field with all that it was computed from.
struct Field {
  core::Solid solid;
  core::Lattice lattice;
  core::DirectionSet directions;
  std::vector<core::FieldValue> value;  ///< mesh units; by sample point

  double volume() const { return solid.volume; }
};

/// The parts of a field but its values.
Field prepare(const core::Mesh& mesh, const core::LatticeGrid& grid, const std::string& directions);

/// The parts of a field but its values, in the solid's affine frame: about `points` sample points.
Field prepare_affine(const core::Mesh& mesh, const std::string& directions, std::uint64_t points = 150);

/// The values of a prepared field, of all its directions.
void compute_values(Field& field);

/// Values of the directions `list` alone, scaled units, as they come from the core.
std::vector<core::FieldValue> scaled_values(const Field& field, const std::vector<std::uint32_t>& list,
                                            unsigned threads = 1);

/// The whole field.
Field compute(const core::Mesh& mesh, const core::LatticeGrid& grid,
              const std::string& directions = "triangles");

/// How far two fields differ, point by point.
struct Deviation {
  double of_volume = 0;   ///< the largest |a - b|, of v0
  double of_erosion = 0;  ///< the largest |a - b| / a
  double of_bound = 0;    ///< the largest |a - b| / (relative a + absolute v0)
};

/// @param factor by which b's volumes are larger than a's.
/// @throws std::invalid_argument when the fields have not the same number of points.
Deviation deviation(const Field& a, const Field& b, double relative, double absolute, double factor = 1);

}  // namespace affskel::property

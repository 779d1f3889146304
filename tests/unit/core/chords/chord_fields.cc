#include "core/chords/chord_fields.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/infimum/refine.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// Smallest box along the given axes round the solid's bounding box, in steps.
LatticeGrid frame_round(const Solid& solid, const std::array<Vec3, 3>& axes) {
  const double volume = dot(axes[0], cross(axes[1], axes[2]));
  LatticeGrid grid;
  Vec3 centre;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 dual = (solid.scale() / volume) * cross(axes[(k + 1) % 3], axes[(k + 2) % 3]);
    double low = 0, high = 0;
    for (const Vec3& p : solid.mesh.points) {
      low = std::min(low, dot(dual, p));
      high = std::max(high, dot(dual, p));
    }
    grid.axes[k] = (1 / solid.scale()) * axes[k];
    grid.dims[k] = static_cast<std::uint32_t>(std::ceil(high - low));
    centre = centre + (0.5 * (low + high) - 0.5 * (grid.dims[k] - 1.0)) * grid.axes[k];
  }
  grid.origin = centre;
  return grid;
}

FrameField eroded(const Solid& solid, const Lattice& lattice, const std::string& spec, bool refined,
                  std::vector<std::array<std::uint32_t, 2>>& saddles) {
  DirectionSet directions = make_directions(solid, spec);
  Erosion erosion(solid, lattice, directions, {});
  std::vector<std::uint32_t> list(directions.size());
  std::iota(list.begin(), list.end(), 0U);
  ExecutionContext context;
  erosion.run(list, context);
  std::vector<FieldValue> values;
  for (std::uint32_t p = 0; p < lattice.points; ++p) values.push_back(erosion.field().value(p));
  if (refined) {
    const auto least = refine(PieceInput(solid), lattice, directions, erosion.field(), 1, context);
    directions.assign(least.size(), {});
    for (std::uint32_t p = 0; p < lattice.points; ++p) {
      directions[p] = least[p].normal;
      saddles.push_back(least[p].saddles);
      values[p] = {least[p].erosion, least[p].slope, p};
    }
  }
  for (FieldValue& value : values) {
    value.area *= solid.scale() * solid.scale();
    value.erosion *= solid.scale() * solid.scale() * solid.scale();
  }
  return frame_field(lattice, directions, values);
}

}  // namespace

Branch linear_branch(double constant, const Vec3& slope) {
  return {[=](const Vec3& u) { return constant + dot(slope, u); }, [=](const Vec3&) { return slope; }};
}

BoxLattice::BoxLattice(double a, double b, double c) : BoxLattice(make_box(a, b, c)) {}

BoxLattice::BoxLattice(const Mesh& box)
    : solid(make_solid(box)),
      lattice(make_lattice(solid, frame_round(solid, {Vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}))) {}

FrameField field_of_branches(const Lattice& lattice, const std::vector<Branch>& branches) {
  FrameField field;
  field.spacing = lattice.spacing;
  for (const LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const auto [i, j, k] = run.start;
      const Vec3 u =
          lattice.spacing * Vec3{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k + n)};
      std::uint32_t least = 0;
      for (std::uint32_t b = 1; b < branches.size(); ++b) {
        if (branches[b].erosion(u) < branches[least].erosion(u)) least = b;
      }
      field.erosion.push_back(branches[least].erosion(u));
      field.gradient.push_back(branches[least].gradient(u));
      field.direction.push_back(least);
    }
  }
  return field;
}

std::array<Vec3, 3> cubic_axes(double h) {
  return {Vec3{h, 0, 0}, Vec3{0, h, 0}, Vec3{0, 0, h}};
}

ErodedSolid::ErodedSolid(const Mesh& mesh, const std::array<Vec3, 3>& axes, const std::string& directions,
                         bool refined)
    : solid(make_solid(mesh)),
      lattice(make_lattice(solid, frame_round(solid, axes))),
      field(eroded(solid, lattice, directions, refined, saddles)) {}

Vec3 ErodedSolid::place(const Vec3& u) const {
  const SamplePlaces places(solid, lattice);
  const std::array<Vec3, 3> f = frame_matrix(lattice);
  return places.origin() + (u.x * f[0] + (u.y * f[1] + u.z * f[2]));
}

}  // namespace affskel::core

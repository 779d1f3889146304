#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"
#include "core/shapes/shapes.h"

namespace affskel::core {

/// A block of nx x ny x nz sample points at the given spacing with a normal of its own at each, for tests of
/// the shock operators.
class NormalBlock {
 public:
  using Indices = std::array<std::uint32_t, 3>;

  explicit NormalBlock(const Indices& dims, double spacing = 1)
      : solid(make_solid(make_box(spacing * dims[0], spacing * dims[1], spacing * dims[2]))), dims_(dims) {
    const double step = spacing / solid.scale();
    LatticeGrid grid;
    grid.axes = {Vec3{step, 0, 0}, {0, step, 0}, {0, 0, step}};
    grid.origin = -0.5 * step * Vec3{dims[0] - 1.0, dims[1] - 1.0, dims[2] - 1.0};
    grid.dims = dims;
    lattice = make_lattice(solid, grid);
    lattice.spacing = spacing;
  }

  std::uint32_t at(const Indices& p) const { return (p[0] * dims_[1] + p[1]) * dims_[2] + p[2]; }

  /// Gives every point the normal of its place.
  template <class Normal>
  NormalBlock& fill(Normal normal) {
    normals.clear();
    optimal.clear();
    for (std::uint32_t i = 0; i < dims_[0]; ++i) {
      for (std::uint32_t j = 0; j < dims_[1]; ++j) {
        for (std::uint32_t k = 0; k < dims_[2]; ++k) {
          optimal.push_back(static_cast<std::uint32_t>(normals.size()));
          normals.push_back(normal(Indices{i, j, k}));
        }
      }
    }
    return *this;
  }

  Solid solid;
  Lattice lattice;
  DirectionSet normals;
  OptimalDirections optimal;

 private:
  Indices dims_;
};

/// `jump` / 2 along `axis` up to the layer `below`, - `jump` / 2 from the next one on; the rest along the
/// axis after it: normals that run into a sheet between the two layers.
inline Vec3 jumping_normal(const NormalBlock::Indices& p, std::size_t axis, std::uint32_t below,
                           double jump) {
  std::array<double, 3> n{};
  n[axis] = p[axis] <= below ? jump / 2 : -jump / 2;
  n[(axis + 1) % 3] = std::sqrt(1 - jump * jump / 4);
  return {n[0], n[1], n[2]};
}

}  // namespace affskel::core

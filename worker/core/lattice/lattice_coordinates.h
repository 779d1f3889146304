#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice/lattice.h"

namespace affskel::core {

/// Lattice indices (i, j, k).
using LatticePlace = std::array<std::uint32_t, 3>;

/// Where sample points stand, found in one walk over the runs.
/// @param points ranks of sample points, ascending.
std::vector<LatticePlace> lattice_places(const Lattice& lattice, std::span<const std::uint32_t> points);

/// Place (i, j, k) of a grid, in its own coordinates.
inline Vec3 grid_place(const LatticeGrid& grid, std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  return grid.origin + (double(i) * grid.axes[0] + (double(j) * grid.axes[1] + double(k) * grid.axes[2]));
}

/// Whether the axes of a grid are those of its coordinates, in their sense.
inline bool is_upright(const LatticeGrid& grid) {
  const auto& [x, y, z] = grid.axes;
  return x.y == 0 && x.z == 0 && y.x == 0 && y.z == 0 && z.x == 0 && z.y == 0 && x.x > 0 && y.y > 0 &&
         z.z > 0;
}

/// Scaled coordinates of the solid for real lattice indices.
inline Vec3 scaled_place(const Lattice& lattice, const Vec3& indices) {
  const LatticeGrid& grid = lattice.grid;
  return grid.origin + (indices.x * grid.axes[0] + (indices.y * grid.axes[1] + indices.z * grid.axes[2]));
}

}  // namespace affskel::core

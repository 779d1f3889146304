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

/// Scaled coordinates of the solid for real lattice indices.
inline Vec3 scaled_place(const Lattice& lattice, const Vec3& indices) {
  const LatticeGrid& grid = lattice.grid;
  return grid.origin + (indices.x * grid.axes[0] + (indices.y * grid.axes[1] + indices.z * grid.axes[2]));
}

}  // namespace affskel::core

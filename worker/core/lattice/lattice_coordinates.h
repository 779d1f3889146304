#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/matrix3.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// Lattice indices (i, j, k).
using LatticePlace = std::array<std::uint32_t, 3>;

/// The run along the last axis that a sample point is in.  O(log runs).
const LatticeRun& run_of(const Lattice& lattice, std::uint32_t point);

/// Whether the place of the lattice that is nearest to real indices is a sample point.  O(log runs).
bool is_sample_point(const Lattice& lattice, const Vec3& indices);

/// Where sample points stand.  O(1) for those that follow each other in a run.
/// @param points ranks of sample points.
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

/// Whether they are so, and of one length.
inline bool is_cubic(const LatticeGrid& grid) {
  return is_upright(grid) && grid.axes[0].x == grid.axes[1].y && grid.axes[0].x == grid.axes[2].z;
}

/// Scaled coordinates of the solid for real lattice indices.
inline Vec3 scaled_place(const Lattice& lattice, const Vec3& indices) {
  const LatticeGrid& grid = lattice.grid;
  return grid.origin + (indices.x * grid.axes[0] + (indices.y * grid.axes[1] + indices.z * grid.axes[2]));
}

/// The same for coordinates of the lattice's frame (see frame_field.h).
inline Vec3 scaled_from_frame(const Lattice& lattice, const Vec3& u) {
  return scaled_place(lattice, (1 / lattice.spacing) * u);
}

/// Real lattice indices for scaled coordinates of the solid.
class LatticeIndices {
 public:
  explicit LatticeIndices(const Lattice& lattice)
      : origin_(lattice.grid.origin), rows_(inverse_transposed(lattice.grid.axes)) {}

  Vec3 operator()(const Vec3& scaled) const { return transposed_times(rows_, scaled - origin_); }

 private:
  Vec3 origin_;
  Matrix3 rows_;  // of the axes' inverse
};

/// The surface of a solid in real lattice indices.
Mesh surface_in_lattice(const Solid& solid, const Lattice& lattice);

}  // namespace affskel::core

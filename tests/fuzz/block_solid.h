#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::fuzz {

/// A solid of blocks: the full cells of a grid whose planes lie at any distances.  Thin plates, faces in one plane, edges
/// and corners where parts touch, and cavities come by themselves; volume and erosion levels along the axes are sums over
/// cells.
struct BlockSolid {
  std::array<std::vector<double>, 3> planes;  ///< ascending; one more than cells
  std::vector<bool> full;                     ///< cell (i, j, k) at (i ny + j) nz + k

  std::size_t cells(std::size_t axis) const { return planes[axis].size() - 1; }
  std::size_t cell(std::size_t i, std::size_t j, std::size_t k) const {
    return (i * cells(1) + j) * cells(2) + k;
  }

  /// Its boundary, outward, two triangles for each face of a cell.  Corners at one place are one vertex, so that edges at
  /// which parts touch have four triangles.
  core::Mesh mesh() const;

  double volume() const;

  /// How many pieces of its interior there are: cells that share a face hang together.
  std::size_t solids() const;

  /// The least volume that a plane through x, perpendicular to an axis, cuts off with x, either way.
  /// @param x inside, on none of the planes. @return 0 outside.
  double axis_erosion(const core::Vec3& x) const;

 private:
  std::array<std::size_t, 3> at(std::size_t cell) const;
  double side(std::size_t axis, std::size_t cell) const {
    return planes[axis][cell + 1] - planes[axis][cell];
  }
  template <typename Visit>
  void for_each_neighbour(std::size_t cell, Visit visit) const;
  double piece(std::size_t from, std::size_t axis, double height, bool below) const;
};

}  // namespace affskel::fuzz

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"
#include "core/mesh/edges.h"

namespace affskel::core {

/// What is left of a collapsed complex, its vertices numbered: the topology of the skeleton's mesh.
struct SkeletonCells {
  using Cell = DualComplex::Cell;

  /// A mesh tells edges by their ends.  On both sides of a gap thinner than the spacing edges of the complex may have
  /// the same ends, and squares the same opposite corners: of those each but the first gets a vertex in its middle,
  /// and so do the squares of such edges, so that the mesh has the topology of the complex.
  /// @param left squares, edges and vertices, closed under taking boundaries.
  SkeletonCells(const DualComplex& complex, const CellSet& left);

  /// Of a vertex: its place among `vertices`, or that of what comes after it.
  std::uint32_t number(Cell vertex) const;

  /// Of each vertex those at the other ends of its segments that have one square.
  Adjacency rim_neighbours() const;

  std::vector<Cell> vertices;  ///< ascending; edges and squares are those in their middles
  std::vector<Cell> squares;   ///< ascending
  std::vector<std::array<std::uint32_t, 4>> rings;  ///< per square: its corners, once round
  std::vector<char> fanned;                         ///< per square: it has a vertex in its middle
  std::vector<Triangle> fans;                       ///< about these, which come first
  std::vector<Segment> segments;         ///< the ends of edges, and from middles of squares outwards
  std::vector<std::uint8_t> squares_at;  ///< per segment: how many squares have it
};

}  // namespace affskel::core

#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/groups.h"
#include "core/collapse/dual_complex.h"

namespace affskel::core {

/// What is left of a collapsed complex, its vertices numbered: the topology of the skeleton's mesh.
class SkeletonCells {
 public:
  using Cell = DualComplex::Cell;

  /// Of edges with the same ends, as on both sides of a gap thinner than the spacing, one is a segment, and each other
  /// that no square has becomes two, with a vertex between: a mesh holds one segment from end to end.
  /// @param left squares, edges and vertices, closed under taking boundaries.
  SkeletonCells(const DualComplex& complex, const CellSet& left);

  /// Of a vertex: its place among `vertices`, or that of what comes after it.
  std::uint32_t number(Cell vertex) const;

  /// Of each vertex those at the other ends of its segments; and of those segments alone that have one square.
  Groups<std::uint32_t> neighbours() const;
  Groups<std::uint32_t> rim_neighbours() const;

  std::vector<Cell> vertices;                          ///< ascending; an edge is the vertex in its middle
  std::vector<Cell> squares;                           ///< ascending
  std::vector<std::array<std::uint32_t, 4>> rings;     ///< per square: its vertices, once round
  std::vector<std::array<std::uint32_t, 2>> segments;  ///< the ends of edges
  std::vector<std::uint8_t> squares_at;                ///< per segment: how many squares have it

 private:
  std::array<std::uint32_t, 2> ends(const DualComplex& complex, Cell edge) const;
  void split_doubled(const DualComplex& complex, const std::vector<Cell>& edges);
};

}  // namespace affskel::core

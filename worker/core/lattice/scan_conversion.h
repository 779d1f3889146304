#pragma once

#include <cstdint>
#include <vector>

#include "core/lattice/lattice.h"

namespace affskel::core {

/// One crossing of a lattice line with the surface.
struct Crossing {
  double depth = 0;  ///< lattice coordinate along the line
  std::uint32_t triangle = 0;
  std::int32_t exits = 0;  ///< +1: the line leaves the solid here (upward), -1: it enters
};

/// Crossings of all lattice lines along one axis, each line's sorted by (depth, exits before entries,
/// triangle).  With u = (axis + 1) % 3 and v = (axis + 2) % 3 the line through (u, v) = (m, n) is number
/// m * dims[v] + n.
struct LineCrossings {
  std::vector<std::uint64_t> begin;  ///< per line, and one past the end
  std::vector<Crossing> crossings;
};

/// Watertight scan conversion of the surface along `axis`: every line enters each closed surface as often as
/// it leaves it, whatever the rounding.  On up to `threads` threads.
/// @throws CoreError kCancelled when the context, if there is one, asks to stop.
LineCrossings scan_convert(const Mesh& mesh, const LatticeGrid& grid, int axis, unsigned threads = 1,
                           ExecutionContext* context = nullptr);

/// A crossing and the line it lies on, numbered as in LineCrossings.
struct CrossingOnLine {
  std::uint64_t line = 0;
  Crossing crossing;
};

/// The same crossings line by line, only for lines that the surface meets: for grids with far more lines than
/// those.  Memory in the order of the vertices and the crossings.
std::vector<CrossingOnLine> scan_convert_lines_met(const Mesh& mesh, const LatticeGrid& grid, int axis,
                                                   ExecutionContext* context = nullptr);

}  // namespace affskel::core

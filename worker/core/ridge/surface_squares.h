#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/contour/edge_cells.h"
#include "core/contour/sheet_mesh.h"

namespace affskel::core {

/// Where ridges cross the lattice: a square for each crossing, with a vertex of the surface at each corner.
struct CrossedSquares {
  const EdgeCells& cells;
  std::span<const SheetVertex> vertices;  ///< of the surface, one per cell
  std::span<const double> strength;       ///< per square: of its crossing, radians
  std::span<const double> radius;         ///< per square: distance to the surface of the solid, spacings, > 0
};

struct SurfaceSquares {
  std::vector<char> taken;           ///< per square
  std::vector<std::uint32_t> piece;  ///< per square: the least square of its piece
};

/// The squares that the ridge surface is made of.
/// 1. Those with a vertex of s >= low.
/// 2. Without those that stand on others: crossings below 1.5 low that would be the third or fourth at an edge.  Where a
///    limb is nearly round, e turns from point to point, and weak crossings beside a strip borrow the strength of its
///    vertices.
/// 3. With the weaker ones in gaps between them: morphological closing along the surface (Serra 1982).  What is nearer to
///    strong squares than `gap`, and farther than that, by a square and a half, from what is not, or from where the surface
///    ends.
/// Pieces are formed over edges with a strong end, and over all edges of what closes gaps; of more than two squares at an
/// edge by the two that go on in each other, so that what stands on a sheet is a piece of its own.
/// A function of its arguments alone; the lower `low`, the more.
/// @param gap half the width of gaps, radii.
SurfaceSquares surface_squares(const CrossedSquares& squares, double low, double gap);

}  // namespace affskel::core

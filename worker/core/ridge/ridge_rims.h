#pragma once

#include <cstdint>
#include <vector>

#include "core/contour/sheet_mesh.h"
#include "core/ridge/ridge_constants.h"

namespace affskel::core {

/// Bounds on the strength of a sheet and of curves, radians.
struct RidgeBounds {
  double low = 6;     ///< the sheet ends where its strength falls below this, > 0; the threshold of `ridge`
  double high = 6.5;  ///< a piece has this strength somewhere, >= low
};

/// What cutting has left.
struct RidgePieces {
  std::vector<double>
      shares;  ///< of what is kept, pieces joined as one: of the area in their part, largest first
  std::uint32_t bridges = 0;   ///< ways that join them
  double max_strength = 0;     ///< of the sheet before it was cut
  double max_piece_share = 0;  ///< largest share that a piece has, kept or not
};

/// Cuts a sheet to what is strong, by two bounds (hysteresis):
/// 1. vertices with s >= low that triangles join form pieces; those without a vertex of s >= high that is not
///    round, and those too small, are dropped; of a part that has none but round ones the vertex of greatest
///    E stays, with the triangles round it: its skeleton is a point;
/// 2. the others of a part are joined, as far as the weaker sheet connects them, by the ways along its edges
/// of
///    least cost, an edge costing its length times low / s; what lies on such a way is kept as if it had s =
///    low;
/// 3. triangles with a strong corner stay, and their weak corners are drawn back to the line s = low: to the
/// mean
///    of its places, by linear interpolation, on the edges to strong corners.  So rims are lines, not stairs,
///    and gaps one edge wide close.
/// A function of the mesh alone.  O(n log n).
/// @param mesh distinct triangles, each with three distinct corners.
/// @throws CoreError kBadInput when a bound is out of range.
RidgePieces cut_rims(SheetMesh& mesh, const RidgeBounds& bounds = {}, const RidgeConstants& constants = {});

}  // namespace affskel::core

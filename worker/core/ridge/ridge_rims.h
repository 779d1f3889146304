#pragma once

#include <cstdint>
#include <vector>

#include "core/contour/sheet_mesh.h"

namespace affskel::core {

struct RidgeRimOptions {
  double low = 6;     ///< the sheet ends where its strength falls below this, radians, > 0
  double high = 6.5;  ///< a piece has this strength somewhere, >= low
  /// ... and, there, at most this lambda_3 / lambda_1: about the centre of a ball E falls alike in all
  /// directions, and e is any of them.
  double max_roundness = 0.8;
  /// Pieces that the weaker sheet connects are weighed as one, and dropped with less than this share of the
  /// area above `low` in their part of the solid, 0 .. 1.
  double significance = 0.001;
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
/// @throws CoreError kBadInput when an option is out of range.
RidgePieces cut_rims(SheetMesh& mesh, const RidgeRimOptions& options = {});

}  // namespace affskel::core

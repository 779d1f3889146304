#pragma once

#include <cstdint>
#include <vector>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

/// The connected pieces of a sheet of `chords` or `ridge`, heaviest first.
struct SheetPieces {
  std::vector<std::uint32_t> piece;  ///< per triangle, then per segment: its piece
  std::vector<double> shares;        ///< per piece, its share of the sheet's weight, 0 .. 1
};

/// Triangles and segments with a common vertex belong to one piece.  A triangle weighs its area times the
/// mean strength of its corners, a segment what the square over it would.  The significance of `chords` is
/// another share: it weighs lattice edges, also by the angle between their two normals, and is taken before
/// pieces are joined.
/// @param sheet with its strengths; its corners exist.
SheetPieces sheet_pieces(const v1::TriangleMesh& sheet);

}  // namespace affskel::client

#pragma once

#include <vector>

#include "core/chord_shocks.h"
#include "core/frame_field.h"
#include "core/lattice.h"
#include "core/solid_parts.h"

namespace affskel::core {

struct LevelEdgeOptions {
  /// Least turn of the shocks that make up the sheet, 0 .. 1.
  double least_turn = 0.5;
  /// Least opening of an edge in the sheet, 0 .. 1: its ends stand on the two sides of one jump, next to it,
  /// and not reach edges away as those of a turn.
  double least_opening = 0.1;
};

/// Adds the shocks of lattice edges that lie in the sheet, and so are not across it.
///
/// A sample point on the sheet has two equal chords and belongs to either side by chance (to the lesser
/// direction, where they are equal to the last bit, as in the middle of a solid that is its own mirror
/// image).  Where neighbours on the sheet belong to different sides, the sheet passes below one of them and
/// above the other, and between them through their common edge: along that the two tangents have the same
/// slope, so that nothing of it shows in chord_shocks(), and the sheet would fall apart into as many pieces
/// as chance makes.  It shows in the squares above and below the edge: both have one shock on their four
/// edges, which no closed way across a sheet can have.
///
/// So that an edge without a shock of that turn becomes one when its ends' normals differ by the least
/// opening and when both squares on opposite sides of it lie on the rim of the sheet.  It takes strength and
/// turn from the weaker of the two shocks that these squares have, and lies in the middle of the edge.
/// Invariance: that of the turn (see measure_turns).
/// @param parts of the solid in this lattice.
/// @param shocks of this lattice and field, by (point, axis), each edge once, their turns measured; is still
///   so afterwards.
/// @throws CoreError kBadInput when an option is out of range.
void add_level_edges(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                     std::vector<ChordShock>& shocks, const LevelEdgeOptions& options = {});

}  // namespace affskel::core

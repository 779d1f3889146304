#pragma once

#include <span>
#include <vector>

#include "core/chords/chord_shocks.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

/// The shocks that a sheet lacks where all of its surroundings ask for one.
///
/// A square of the lattice with a single shock on its four edges lies on the sheet's rim (see
/// chord_squares.h). When three or four squares round a lattice edge are such, the sheet ends on most sides
/// of that edge: it passes between the edge's ends, and the tangents there merely fail to say where (a third
/// branch comes between, or the two bend more than the slack of chord_shocks() allows).  That is a hole as
/// large as one edge's quadrilateral, or a corner of a larger one.  Its shock lies where the tangents cross,
/// moved to the nearer end when that is outside the edge, to the middle when they do not cross; its strength
/// is 0 then.
///
/// Edges whose ends have the same optimal direction stay open: no two chords are equal there.
/// @param parts of the solid in this lattice.
/// @param shocks of this lattice, each edge once.
/// Returns the missing ones by (point, axis), their turn that of the edge alone.  O(n log n + n log R), R the
/// sample points.
std::vector<ChordShock> pinhole_shocks(const Lattice& lattice, const SolidParts& parts,
                                       const FrameField& field, std::span<const ChordShock> shocks);

}  // namespace affskel::core

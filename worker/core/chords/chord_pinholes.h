#pragma once

#include <span>
#include <vector>

#include "core/chords/chord_shocks.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

/// The shocks that a sheet lacks: one on every edge of which three or four of the squares round it lie on the
/// sheet's rim (see chord_squares.h).  A shock lies where the tangents cross, clamped to the edge, or in the
/// middle with the strength 0 when they do not cross.  Edges whose ends have the same optimal direction stay
/// open: no two chords are equal there.
/// @param parts of the solid in this lattice.
/// @param shocks of this lattice, each edge once.
/// @return the missing ones by (point, axis), their turn that of the edge alone.  O(n log n + n log R), R the
///   sample points.
std::vector<ChordShock> pinhole_shocks(const Lattice& lattice, const SolidParts& parts,
                                       const FrameField& field, std::span<const ChordShock> shocks);

}  // namespace affskel::core

#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/chords/chord_shocks.h"
#include "core/erosion/frame_field.h"
#include "core/infimum/piece_input.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// What a field over all directions knows of the least pieces beyond E and its gradient.
struct RefinedPieces {
  const PieceInput& input;                                ///< of the solid
  std::span<const std::array<std::uint32_t, 2>> saddles;  ///< per sample point: LeastChord::saddles
  unsigned threads = 1;                                   ///< >= 1; the result does not depend on it
};

/// Moves shocks to where the two chords are equal, without extrapolation (Zografos 2003, section 3.4: points with two
/// equal optimal chords).
///
/// The optimal planes of the edge's two ends are two minima of f(d) = chord(p, d).  Both are followed from their ends
/// to places p on the edge (ChordDescent), each beyond the place where it is the least one, by Newton's method on the
/// difference of their volumes, whose derivative is known (see README.md in worker/core).  The shock gets the place
/// where they are equal, to 1e-9 of E, or where the greater jumps below the lesser, with E and the two gradients there.
/// One whose two planes lead to one piece wherever they are looked at, since the normals between them turn and
/// nowhere jump, stays where the tangents cross, and `turns` is set.
/// @param field over all directions, of this lattice.
/// @param shocks of this field.
/// @throws CoreError kCancelled when the context asks to stop.
void place_at_equal_chords(const Solid& solid, const Lattice& lattice, const FrameField& field,
                           const RefinedPieces& pieces, std::vector<ChordShock>& shocks,
                           ExecutionContext* context);

}  // namespace affskel::core

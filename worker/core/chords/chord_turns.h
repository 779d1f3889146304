#pragma once

#include <vector>

#include "core/base/execution_context.h"
#include "core/chords/chord_shocks.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

// Notation.  d = E / |g|, |g| the mean of the shock's two, is its depth: the mean height of its chords over
// their sections.  h is the spacing.

/// Measures how far the optimal normals turn across each shock, and sets its `turn`.  A peak (the largest
/// kink among the shocks near it on a line) takes the turn over its band, then the mean along the sheet; all
/// other shocks keep their own opening.  Step by step: chord_turns.cc.
///
/// Kinks and their ratios are affinely invariant; jump, depth and band are so as the opening is (see
/// chord_shocks.h).
/// @param parts of the solid in this lattice.
/// @param shocks of this lattice and field, by (point, axis), each edge once.
/// @param context asked whether to stop.
/// @throws CoreError kLimit for 2^30 shocks and more; kCancelled when the context asks to stop.
void measure_turns(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                   std::vector<ChordShock>& shocks, ExecutionContext* context = nullptr,
                   const ChordConstants& constants = {});

}  // namespace affskel::core

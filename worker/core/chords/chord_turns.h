#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/chords/chord_shocks.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

// Notation.  d = E / |g|, |g| the mean of the shock's two, is its depth: the mean height of its chords over
// their sections.  h is the spacing.  Reasons of the constants: README.md in worker/core.

struct ChordTurnOptions {
  /// Width of the band across the sheet, along a lattice line, as a share of the depth d, >= 0; at least the
  /// shock's own edge, at most 64 edges to either side of it.
  double width = 0.7;
  /// Least jump |g_x - g_y| of a peak, as a share of the largest jump at most as many cells away as the band
  /// reaches, 0 .. 1.
  double min_share = 0.4;
  /// Least kink s of a peak, as a share of the change of slope over its band, 0 .. 1.
  double min_concentration = 0.2;
  /// Least relative strength r of a peak, 0 .. 1.
  double min_strength = 0.56;
  /// Rounds of averaging along the sheet, at most 16.
  std::uint32_t rounds = 1;
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// Measures how far the optimal normals turn across each shock, and sets its `turn`.  A peak (the largest
/// kink among the shocks near it on a line) takes the turn over its band, then the mean along the sheet; all
/// other shocks keep their own opening.  Step by step: chord_turns.cc.
///
/// Kinks and their ratios are affinely invariant; jump, depth and band are so as the opening is (see
/// chord_shocks.h).
/// @param parts of the solid in this lattice.
/// @param shocks of this lattice and field, by (point, axis), each edge once.
/// @throws CoreError kBadInput when an option is out of range; kLimit for 2^30 shocks and more; kCancelled
///   when the context asks to stop.
void measure_turns(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                   std::vector<ChordShock>& shocks, const ChordTurnOptions& options = {});

}  // namespace affskel::core

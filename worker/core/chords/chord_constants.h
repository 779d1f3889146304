#pragma once

#include <cstdint>

namespace affskel::core {

/// What the sheet of `chords` is made with, found by experiments; tests take other values, and the infimum (see
/// constants_of_infimum()).  In the notation of chord_shocks.h, chord_turns.h and chord_pruning.h; reasons: README.md
/// in worker/core.
struct ChordConstants {
  // Candidates.
  double min_strength = 0.05;  ///< least relative strength r, 0 .. 1
  double min_opening = 0.005;  ///< least opening o of the two normals, 0 (equal) .. 1 (opposite)
  double slack = 0.25;  ///< how far outside [0, 1] t may lie, edges; it is then moved to the nearer end

  // Turns.
  /// Width of the band across the sheet, along a lattice line, as a share of the depth d; at least the
  /// shock's own edge, at most 64 edges to either side of it.
  double width = 0.7;
  /// Least jump |g_x - g_y| of a peak, as a share of the largest jump at most as many cells away as the band
  /// reaches, 0 .. 1; 0: none is asked.
  double min_share = 0.4;
  double min_concentration =
      0.2;  ///< least kink s of a peak, as a share of the change of slope over its band
  double min_peak_strength = 0.56;  ///< least r of a peak, 0 .. 1
  std::uint32_t rounds = 1;         ///< of averaging along the sheet

  // Pruning.
  double strong_turn = 0.45;  ///< least turn of a strong shock; 1/2 is a right angle between its normals
  double min_erosion =
      0.002;              ///< its least E, as a share of the volume of the sample points' cells in its part
  double near_cost = 20;  ///< pieces that a path through weaker shocks joins at this cost are weighed as one
  /// Where no turn is as wide as strong_turn, a strong one has this share of the largest turn instead, but at
  /// least min_strong_turn.
  double strong_share = 0.8;
  double min_strong_turn = 0.1;
};

/// Of a field over all directions.  Its normals have no facets beside the sheet that a small jump would belong to; a
/// peak must be more concentrated instead, which keeps smooth ridges from being taken for shocks.  Nor need a peak be
/// stronger than one half, from which on it is none between two facets of one side.
constexpr ChordConstants constants_of_infimum() {
  ChordConstants constants;
  constants.min_share = 0;
  constants.min_concentration = 0.3;
  constants.min_peak_strength = 0.5;
  constants.strong_turn = 0.44;
  return constants;
}

}  // namespace affskel::core

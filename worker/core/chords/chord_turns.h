#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/chords/chord_shocks.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/solid_parts.h"

namespace affskel::core {

// Notation.  d = E / |g|, |g| the mean of the shock's two, is its depth: the mean height of the piece that
// its chords cut off, over their section.  h is the spacing.

struct ChordTurnOptions {
  /// Width of the band across the sheet, along a lattice line, over which the normals' turn is measured, as a
  /// share of the depth d, >= 0; at least the shock's own edge, at most 64 edges to either side of it.
  double width = 0.7;
  /// Least jump |g_x - g_y| of a shock that speaks for those round it, as a share of the largest one that
  /// candidates lead to within as many cells as the band reaches, 0 .. 1.  Beside a sheet the normals turn
  /// fast along it, too, where it ends or where chords hang on to a few directions; the sheet itself jumps
  /// more.
  double min_share = 0.4;
  /// Least kink s of a shock that speaks, as a share of the change of slope over its band, 0 .. 1.  Round the
  /// centre of a ball the normals turn by a right angle within the band, too, but evenly, in the many small
  /// steps of the direction set.
  double min_concentration = 0.2;
  /// Least relative strength r of a shock that speaks, 0 .. 1.  Below one half E hardly falls to one side of
  /// it: it lies between two facets of one side.  Where a torus of few triangles bends away from its sheet,
  /// such pairs of facets, 0.55 and less, would be wings beside it.
  double min_strength = 0.56;
  /// Rounds of averaging along the sheet, at most 16.
  std::uint32_t rounds = 1;
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// Measures how far the optimal normals turn across each shock, and sets its `turn`.
///
/// A finite set of directions, and noise on the vertices all the more, break up one jump of the normals into
/// several small ones near each other: which of them is the widest changes with every perturbation, their sum
/// does not.  So that of all candidates on a lattice line within the reach q = (width d / h - 1) / 2 edges of
/// each other (rounded) the one with the largest kink s (the first of equal ones) speaks for all: its turn is
/// the opening between the places q edges beyond both of its ends (in the solid, as far as the line stays in
/// it; between two sample points in proportion), at least its own.  The others keep their own opening, and so
/// do one that is weak (min_strength), one where the normals turn evenly (min_concentration) and one
/// beside a sheet that jumps much more (min_share): the sheet stays one layer (non-maximum suppression, as
/// in Canny 1986).
///
/// The band goes with the solid's own size at the place, not with the lattice: where the spacing is halved it
/// spans twice as many edges, and the sheet at true shocks stays where it is.  A ridge, where the normals
/// turn fast without a jump (the middle plane of a box seen by very many directions), comes apart as the
/// spacing falls: its largest step becomes a small share of its turn.
///
/// Then the turns of those that speak are averaged along the sheet, over the cells of the lattice that they
/// bound: each cell has the mean turn of its shocks, weighted by turn and area (|N_a|, see chord_pruning.h),
/// each shock that of its four cells, but at most twice its own.  Lone facets lose by it, gaps in a sheet
/// gain.
///
/// Measured on mh_man of 292, 1000 and 5000 triangles at a body's height / 180 as spacing: share of the
/// skeleton within delta = sqrt(3)/128 of that height of the skeleton with vertex noise of 1 % of the
/// diagonal, and back, means of 8 seeds: 92.9/93.6 %; by a band of five spacings 94.2/93.6 %, with 51 tunnels
/// for 22; by the shocks' own openings of 1/4 and more (4 seeds) 91.0/89.1 %.  Halving the spacing (90, 180,
/// 360 to the height) moves what lies two coarse spacings from the rim by less than half a coarse spacing,
/// but for 1 to 2 vertices; with a band of five spacings a third of that is lost.
///
/// Invariance: kinks and their ratios are affinely invariant, the jump, the depth and with it the band in
/// the frame's metric only, as the opening is (see chord_shocks.h).
/// @param parts of the solid in this lattice.
/// @param shocks of this lattice and field, by (point, axis), each edge once.
/// @throws CoreError kBadInput when an option is out of range; kLimit for 2^30 shocks and more; kCancelled
/// when
///   the context asks to stop.
void measure_turns(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                   std::vector<ChordShock>& shocks, const ChordTurnOptions& options = {});

}  // namespace affskel::core

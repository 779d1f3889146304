#pragma once

#include <cstdint>
#include <vector>

#include "core/chords/chord_shocks.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid_parts.h"

namespace affskel::core {

struct ChordTurnOptions {
  /// Lattice edges beyond the shock's own, to either side, over which the normals' turn is measured, at most
  /// 16; 0: the shock's own edge alone.
  std::uint32_t reach = 2;
  /// Least jump |g_x - g_y| of a shock that speaks for those round it, as a share of the largest one that
  /// candidates lead to within `reach` cells, 0 .. 1.  Beside a sheet the normals turn fast along it, too,
  /// where it ends or where chords hang on to a few directions; the sheet itself jumps more.
  double least_share = 0.4;
  /// Rounds of averaging along the sheet, at most 16.
  std::uint32_t rounds = 1;
};

/// Measures how far the optimal normals turn across each shock, and sets its `turn`.
///
/// A finite set of directions, and noise on the vertices all the more, break up one jump of the normals into
/// several small ones a step or two apart: which of them is the widest changes with every perturbation, their
/// sum does not.  So that of all candidates on a lattice line within `reach` edges of each other the one
/// with the largest kink s (the first of equal ones) speaks for all: its turn is the opening between the
/// sample points `reach` edges beyond both of its ends (in the solid, as far as the line stays in it), at
/// least its own.  The others keep their own opening, and so does one beside a sheet that jumps much more
/// (least_share): the sheet stays one layer (non-maximum suppression, as in Canny 1986).
///
/// Then the turns of those that speak are averaged along the sheet, over the cells of the lattice that they
/// bound: each cell has the mean turn of its shocks, weighted by turn and area (|N_a|, see chord_pruning.h),
/// each shock that of its four cells, but at most twice its own.  Lone facets lose by it, gaps in a sheet
/// gain.
///
/// Measured on bodies of 292 to 8560 triangles at a body's height / 180 as spacing: share of the skeleton
/// within delta = sqrt(3)/128 of that height of the skeleton with vertex noise of 1 % of the diagonal, and
/// back, means of 3 seeds: 94.1/93.8 % on the five bodies that the options were chosen on, 92.8/92.9 % on six
/// others with other seeds.  By the shocks' own openings of 1/4 and more, it is 90.7/91.0 % and 89.7/89.9 %.
/// Part of the gain is size: on the first five the chance level rises from 27.8 to 30.1 %.  The six were
/// looked at for two earlier variants, too, before the options were settled.
///
/// The band is 2 reach + 1 spacings wide: a ridge that turns more slowly than that is no shock at this
/// spacing. Invariance: that of the opening (see chord_shocks.h).
/// @param parts of the solid in this lattice.
/// @param shocks of this lattice and field, by (point, axis), each edge once.
/// @throws CoreError kBadInput when an option is out of range; kLimit for 2^30 shocks and more.
void measure_turns(const Lattice& lattice, const SolidParts& parts, const FrameField& field,
                   std::vector<ChordShock>& shocks, const ChordTurnOptions& options = {});

}  // namespace affskel::core

#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/erosion/directions.h"
#include "core/erosion/field.h"
#include "core/infimum/least_chord.h"
#include "core/infimum/piece_input.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// What refine() takes in memory for every sample point, bytes.
constexpr double kRefineBytesPerPoint = 2 * sizeof(LeastChord) + 6 * sizeof(std::uint32_t) + 25;

/// Per sample point the least piece over all directions, as far as it is found: E as the definition has it
/// (Zografos 2003, section 2.2.2: an infimum; it is a limit where the optimal plane touches a saddle).
///
/// One point in eight goes down from the direction that its seed was found with (ChordDescent); the others follow
/// their neighbours (Refinement).  Then points try the planes of those near, and planes that touch two of the saddles
/// known there (look_wider), in rounds, until nothing leads lower: as in PatchMatch (Barnes et al. 2009), but all
/// points of a round at once, from what the round before left.  So the result is
/// a function of solid, lattice and seeds.  It is never above the seeds; that it is the infimum is not proven
/// at every point.
///
/// @param threads >= 1; the result does not depend on it.
/// @param seeds the field over `directions`.  A point that lies outside within rounding keeps its value.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<LeastChord> refine(const PieceInput& input, const Lattice& lattice,
                               const DirectionSet& directions, const ErosionField& seeds, unsigned threads,
                               ExecutionContext& context);

}  // namespace affskel::core

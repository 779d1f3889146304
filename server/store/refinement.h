#pragma once

#include <cstdint>
#include <vector>

#include "store/refined.h"
#include "store/rows.h"
#include "store/task_rows.h"
#include "store/tx.h"

namespace affskel::server {

// The stage REFINE of a job whose E is the infimum over all directions: rounds of blocks of points.  A worker that
// computes a block of a round needs all that the round before has left, and nothing of the same round, so that what
// comes out is one function of mesh and parameters; between two rounds all wait for the last block.

/// Begins the stage of a job that owns its erosion, all of whose directions are done; cuts the first blocks.
void begin_refinement(Tx& tx, const JobRow& job);

/// All blocks of the round are done.  Cuts those of the next, and returns false; or true at the end: when a round found
/// nothing, or there were kMostRefineRounds.  The field is then merged.
/// @throws StoreError kDamaged.
bool finish_round(Tx& tx, const JobRow& job);

/// Takes back all that a refinement has found; the stage has not begun.
void forget_refinement(Tx& tx, std::int64_t erosion_id);

/// Stores what a report calls done of a round, each point once: what a repeated report brings is there already.
/// Returns how many points are new.
/// @param ranges within the task's block.
/// @throws StoreError kInvalid when a value lies outside the ranges or above that of the set, or in round 0 is missing.
std::int64_t take_refined(Tx& tx, const JobRow& job, const TaskRow& task, const std::vector<Range>& ranges,
                          const std::vector<wire::RefinedPointRecord>& records);

/// What the refined values of an erosion must keep to.
RefinedBounds refined_bounds(Database& db, std::int64_t erosion_id);

}  // namespace affskel::server

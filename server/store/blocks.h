#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "store/tx.h"

namespace affskel::server {

/// Adds the tasks of an erosion: blocks of positions in the order of work, [0, directions) in all, finer
/// towards the end.
void cut_blocks(Tx& tx, const std::string& job_id, std::int64_t directions);

/// The same for a round of the refinement: blocks of points, [0, points) in all.
/// @param changed the points that the round before changed, ascending: their neighbours are what the round has to do.
///   Null: all points.
void cut_point_blocks(Tx& tx, const std::string& job_id, std::int64_t round, std::int64_t points,
                      const std::vector<std::uint32_t>* changed);

}  // namespace affskel::server

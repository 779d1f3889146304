#pragma once

#include <cstdint>
#include <string>

#include "store/tx.h"

namespace affskel::server {

/// Adds the tasks of an erosion: blocks of positions in the order of work, [0, directions) in all, finer
/// towards the end.
void cut_blocks(Tx& tx, const std::string& job_id, std::int64_t directions);

}  // namespace affskel::server

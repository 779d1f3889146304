#pragma once

#include <cstdint>

#include "store/tx.h"

namespace affskel::server {

/// Goes on with an erosion of which something was taken away: the caller has deleted the done ranges, and
/// values, that do not count any more.  What was derived from the field goes, too.  One of the erosion's
/// jobs, an active one if there is any, computes what is missing on top of what is left.  The others begin
/// anew, and take the field over when it is finished.  Of a field over all directions the refinement begins anew, at
/// once when all directions are done.  All begin anew when no worker has the core that made
/// it any more.
void restart_erosion(Tx& tx, std::int64_t erosion_id, std::int64_t directions);

/// A job goes back to a stage.  What had failed for other reasons or was cancelled stays so, and can be
/// resumed.
void queue_again(Tx& tx, const std::string& job, const char* stage);

}  // namespace affskel::server

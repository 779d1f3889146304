#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "store/rows.h"
#include "store/tx.h"

namespace affskel::server {

// What is finished is kept for so long, or as long as there is room (Policy).  First results go, later the
// job with its mesh; what is pinned, active, or just asked for artefacts stays.  Every removal is planned,
// told (jobs.expires_ms, the log) and done after the grace period, if there is still reason for it then.

/// A removal that there is reason for.
struct Removal {
  std::string job;
  std::int64_t at_ms = 0;  ///< when
  bool with_mesh = false;  ///< the job itself; otherwise its results
  std::string rule;        ///< "results-age", "jobs-age", "stored-bytes" or "total-bytes"
};

/// The next removals to be planned, oldest jobs first, at most `most`; for a read transaction.
std::vector<Removal> removals_to_plan(Database& db, const Policy& policy, std::int64_t now_ms,
                                      std::size_t most);

/// Tells of removals.  Jobs that have changed since they were found are left out.
void plan_removals(Tx& tx, const std::vector<Removal>& removals);

/// Jobs whose removal is planned for now, at most `most`.
std::vector<std::string> removals_due(Database& db, std::int64_t now_ms, std::size_t most);

/// Removes results or job, if there is still reason for it; otherwise takes the plan back.
void carry_out_removal(Tx& tx, const std::string& job_id);

/// Gives the job an erosion of which nothing is done, in the place of its own, which is dropped when no other
/// job needs it.
void begin_erosion_anew(Tx& tx, const JobRow& job);

/// Deletes a job that is not active, and marks what no other job needs for Store::tidy().
void delete_job(Tx& tx, const JobRow& job);

}  // namespace affskel::server

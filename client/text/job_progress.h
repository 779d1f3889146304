#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "affskel/v1/types.pb.h"

namespace affskel::client {

/// What of a job's stage is done: directions or, of a round of the refinement, sample points.
struct JobProgress {
  std::uint64_t done = 0;
  std::uint64_t total = 0;  ///< 0 before it is known
  std::string unit;         ///< "directions", "points of round 3"

  double share() const { return total == 0 ? 0 : std::min(1.0, double(done) / double(total)); }
};

/// The directions, but in the stage REFINE.
inline JobProgress progress_of(const v1::Job& job) {
  if (job.stage() != v1::JOB_STAGE_REFINE)
    return {job.directions_done(), job.directions_total(), "directions"};
  return {job.refined_points(), job.prepared().points(),
          "points of round " + std::to_string(job.refine_round())};
}

}  // namespace affskel::client

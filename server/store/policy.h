#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace affskel::server {

/// What there may be at most; 0 = no limit.
struct Quota {
  std::int64_t queued_jobs = 0;   ///< jobs queued or running
  std::int64_t mesh_bytes = 0;    ///< submitted meshes, each once
  std::int64_t stored_bytes = 0;  ///< meshes, fields and artefacts, each once
  std::int64_t chords = 0;        ///< of one job: sample points x directions
};

/// How long what is finished is kept; 0 = for ever.
struct Retention {
  std::int64_t results_age_ms = 0;  ///< since its job's end
  std::int64_t jobs_age_ms = 0;     ///< the same for the job and its mesh, once its results are gone
  std::int64_t stored_bytes = 0;    ///< above this the oldest go, results before meshes
};

struct OwnerPolicy {
  Quota quota;
  std::int64_t priority = 5;  ///< highest that counts against other owners' jobs, 0 .. 9
  Retention retention;
};

/// What owners may use, and what is kept for them.
struct Policy {
  Quota server;  ///< all owners together, and any job
  OwnerPolicy everyone;
  std::map<std::string, OwnerPolicy> owners;                   ///< instead of `everyone`, complete
  std::int64_t total_bytes = 0;                                ///< retention: stored for all owners together
  std::int64_t grace_ms = std::int64_t{7} * 24 * 3600 * 1000;  ///< between the notice and the removal

  const OwnerPolicy& of(const std::string& owner) const {
    const auto found = owners.find(owner);
    return found == owners.end() ? everyone : found->second;
  }
};

}  // namespace affskel::server

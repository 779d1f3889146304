#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "affskel/v1/types.pb.h"
#include "database/sqlite.h"
#include "store/policy.h"
#include "store/submission.h"

namespace affskel::server {

/// What is in use, of an owner or of all.
struct Use {
  std::int64_t queued_jobs = 0;   ///< queued or running
  std::int64_t mesh_bytes = 0;    ///< each mesh of an owner once
  std::int64_t stored_bytes = 0;  ///< meshes, fields and artefacts, each once of an owner
};

Use use_of(Database& db, const std::string& owner);
Use use_of_all(Database& db);

// Each throws StoreError kLimit that names the limit, what is in use, and what to do.

/// For a submission that becomes a new job.  Points x directions are looked at here as far as the parameters
/// tell them: a number of points, and no directions that depend on the mesh.
void require_quota(Database& db, const Policy& policy, const Submission& submission);

/// For a job that becomes active again.
void require_queue_room(Database& db, const Policy& policy, const std::string& owner);

/// Before something of an owner that is known to take `more` bytes is stored.
void require_stored_room(Database& db, const Policy& policy, const std::string& owner, std::int64_t more);

/// The same for what a worker brings.  @returns why it cannot be stored, if so: a JobError LIMIT.
std::optional<v1::JobError> over_stored_room(Database& db, const Policy& policy, const std::string& owner,
                                             std::int64_t more);

/// For what is known once a job is prepared: its points x directions, and the bytes of its field and lattice.
/// @returns why the job cannot go on, if so: a JobError LIMIT.
std::optional<v1::JobError> over_quota(Database& db, const Policy& policy, const std::string& owner,
                                       const v1::PreparedSummary& prepared, bool refines, std::int64_t bytes);

}  // namespace affskel::server

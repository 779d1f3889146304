#include "store/quota.h"

#include <cmath>

#include "base/direction_set.h"
#include "base/quoted.h"
#include "database/errors.h"
#include "wire/field_record.h"
#include "wire/refined_record.h"

namespace affskel::server {
namespace {

/// One limit: whose, how it is called in the options, and how much of it is used.
struct Bound {
  std::string whose;  // "owner 'ada'" or "this server"
  const char* name;
  const char* unit;
  const char* way_out;
  std::int64_t limit;  // 0 = none
  std::int64_t used;
};

constexpr const char* kDelete = "delete jobs that are no longer needed";
constexpr const char* kWait = "wait until some are finished, or cancel them";
constexpr const char* kCoarser = "take a wider spacing or fewer directions";

std::string refusal(const Bound& bound, std::int64_t more) {
  return bound.whose + " has " + std::to_string(bound.used) + " of " + std::to_string(bound.limit) + " " +
         bound.unit + " (" + bound.name + "), and this takes " + std::to_string(more) + " more; " +
         bound.way_out;
}

void require(const Bound& bound, std::int64_t more) {
  if (bound.limit == 0 || more <= bound.limit - bound.used) return;
  throw StoreError(StoreError::Code::kLimit, refusal(bound, more));
}

std::string name_of(const std::string& owner) {
  return "owner " + base::quoted(owner);
}

constexpr const char* kServer = "this server";

std::string chords_refusal(const std::string& whose, std::int64_t limit, double points, double directions) {
  return "the job has about " + std::to_string(std::llround(points)) + " points x " +
         std::to_string(std::llround(directions)) +
         " directions = " + std::to_string(std::llround(points * directions)) + " chords, and a job of " +
         whose + " may have " + std::to_string(limit) + " (chords); " + kCoarser;
}

/// "" when the job is small enough.
std::string too_many_chords(const Policy& policy, const std::string& owner, double points,
                            double directions) {
  const std::int64_t own = policy.of(owner).quota.chords, all = policy.server.chords;
  const double chords = points * directions;
  if (own != 0 && chords > static_cast<double>(own)) {
    return chords_refusal(name_of(owner), own, points, directions);
  }
  if (all != 0 && chords > static_cast<double>(all)) return chords_refusal(kServer, all, points, directions);
  return {};
}

/// How many directions the parameters ask for at least, wherever the mesh is not needed to tell.
double least_directions(const v1::ErosionParams& params) {
  double count = 0;
  const std::string set = params.directions().empty() ? "triangles" : params.directions();
  for (const base::DirectionSetPart& part : base::parse_direction_set(set)) {
    count += static_cast<double>(part.count);
  }
  return count;
}

Use read_use(Statement&& row) {
  if (!row.step()) return {};
  return {row.integer(0), row.integer(1), row.integer(2)};
}

// Of a mesh that the owner does not have yet.
std::int64_t bytes_not_known(Database& db, const std::string& owner, const std::string& sha256,
                             std::uint64_t bytes) {
  const bool known =
      db.integer("SELECT 1 FROM owner_meshes WHERE owner = ? AND sha256 = ?", owner, sha256).has_value();
  return known ? 0 : static_cast<std::int64_t>(bytes);
}

}  // namespace

Use use_of(Database& db, const std::string& owner) {
  return read_use(
      db.query("SELECT queued_jobs, mesh_bytes, stored_bytes FROM owner_use WHERE owner = ?", owner));
}

Use use_of_all(Database& db) {
  return read_use(db.query("SELECT sum(queued_jobs), sum(mesh_bytes), sum(stored_bytes) FROM owner_use"));
}

void require_queue_room(Database& db, const Policy& policy, const std::string& owner) {
  const Quota& own = policy.of(owner).quota;
  require({name_of(owner), "queued-jobs", "jobs queued or running", kWait, own.queued_jobs,
           use_of(db, owner).queued_jobs},
          1);
  require({kServer, "queued-jobs", "jobs queued or running", kWait, policy.server.queued_jobs,
           use_of_all(db).queued_jobs},
          1);
}

void require_stored_room(Database& db, const Policy& policy, const std::string& owner, std::int64_t more) {
  const Quota& own = policy.of(owner).quota;
  require({name_of(owner), "stored-bytes", "bytes stored", kDelete, own.stored_bytes,
           use_of(db, owner).stored_bytes},
          more);
  require({kServer, "stored-bytes", "bytes stored", kDelete, policy.server.stored_bytes,
           use_of_all(db).stored_bytes},
          more);
}

void require_quota(Database& db, const Policy& policy, const Submission& submission) {
  const v1::SubmitJobHeader& header = submission.header;
  const std::string& owner = header.owner();
  const v1::Sampling& sampling = submission.params.sampling();
  if (sampling.has_target_points()) {
    const std::string why = too_many_chords(policy, owner, static_cast<double>(sampling.target_points()),
                                            least_directions(submission.params));
    if (!why.empty()) throw StoreError(StoreError::Code::kLimit, why);
  }
  require_queue_room(db, policy, owner);
  const std::int64_t bytes =
      bytes_not_known(db, owner, header.mesh_sha256(), header.mesh_bytes()) +
      bytes_not_known(db, owner, header.repair().source_sha256(), header.repair().source_bytes());
  if (bytes == 0) return require_stored_room(db, policy, owner, 0);
  require({name_of(owner), "mesh-bytes", "bytes of meshes", kDelete, policy.of(owner).quota.mesh_bytes,
           use_of(db, owner).mesh_bytes},
          bytes);
  require({kServer, "mesh-bytes", "bytes of meshes", kDelete, policy.server.mesh_bytes,
           use_of_all(db).mesh_bytes},
          bytes);
  require_stored_room(db, policy, owner, bytes);
}

std::optional<v1::JobError> over_stored_room(Database& db, const Policy& policy, const std::string& owner,
                                             std::int64_t more) {
  try {
    require_stored_room(db, policy, owner, more);
    return std::nullopt;
  } catch (const StoreError& refused) {
    v1::JobError error;
    error.set_code("LIMIT");
    error.set_message(refused.what());
    return error;
  }
}

std::optional<v1::JobError> over_quota(Database& db, const Policy& policy, const std::string& owner,
                                       const v1::PreparedSummary& prepared, bool refines,
                                       std::int64_t bytes) {
  v1::JobError error;
  error.set_code("LIMIT");
  error.set_message(too_many_chords(policy, owner, static_cast<double>(prepared.points()),
                                    static_cast<double>(prepared.directions())));
  if (!error.message().empty()) return error;
  const std::size_t per_point = wire::kFieldRecordBytes + (refines ? wire::kRefinedRecordBytes : 0);
  const auto field = static_cast<std::int64_t>(prepared.points() * per_point);
  return over_stored_room(db, policy, owner, field + bytes);
}

}  // namespace affskel::server

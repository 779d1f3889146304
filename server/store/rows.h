#pragma once

#include <string>
#include <utility>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "database/sqlite.h"

namespace affskel::server {

/// Half-open range of positions in the order of work.
struct Range {
  std::int64_t begin = 0;
  std::int64_t end = 0;
  friend bool operator==(const Range&, const Range&) = default;
};

/// A job with its erosion, as the scheduler needs them.
struct JobRow {
  std::string id;
  std::string owner;
  v1::JobState state = v1::JOB_STATE_UNSPECIFIED;
  v1::JobStage stage = v1::JOB_STAGE_UNSPECIFIED;
  bool cancel_requested = false;
  std::int64_t erosion_id = 0;
  std::string skeleton;  // serialized SkeletonParams
  std::string skeleton_key;
  std::string mesh_sha256;
  std::string params_key;
  std::string core_version;  // empty before the prepare stage is done
  std::int64_t points = 0;
  std::int64_t directions = 0;
  std::int64_t directions_done = 0;
  bool refines = false;             // its E is the infimum over all directions
  std::int64_t round = 0;           // of the refinement; 0 also before it begins
  std::int64_t refined_points = 0;  // done in this round
  bool finished = false;
  std::int64_t finished_ms = 0;  // 0 while it is active
  bool pinned = false;
  std::int64_t removed_ms = 0;  // when retention removed its results; 0 = they are kept

  /// QUEUED or RUNNING.
  bool active() const { return state == v1::JOB_STATE_QUEUED || state == v1::JOB_STATE_RUNNING; }
};

/// Reads a job that must exist.  @throws StoreError kNotFound.
JobRow get_job(Database& db, const std::string& id);

/// A job as a caller names it: by its id, a unique prefix of at least 6 characters, or "@last".
struct JobRef {
  JobRef(std::string what) : text(std::move(what)) {}
  JobRef(const char* what) : text(what) {}
  JobRef(std::string what, std::string whose, bool only)
      : text(std::move(what)), owner(std::move(whose)), own_only(only) {}

  std::string text;
  std::string owner;      ///< whose last job "@last" is; empty = anybody's
  bool own_only = false;  ///< the jobs of others do not exist
};

/// Full id of a job.
/// @throws StoreError kNotFound; kInvalid when the prefix is too short or not unique.
std::string resolve_job(Database& db, const JobRef& reference);

/// Code of the error of a job whose data in the database are not what they were.
inline constexpr const char* kDamagedCode = "DAMAGED";

/// The wire form of one job, with its finished positions and what it waits for in vain.  It has the error kDamagedCode
/// when part of it cannot be read.
v1::Job job_message(Database& db, const std::string& id);

/// Changes with every start of a server: the database may have been put back from a copy, or repaired.
std::string database_id(Database& db);

/// What v1::Lease calls the field of an erosion: another name whenever something was taken out of it.
std::string field_name(Database& db, std::int64_t erosion_id);

/// The core version of the workers of this program's version, "" when none was heard from yet.
std::string current_core_version(Database& db);

struct ListFilter {
  std::vector<v1::JobState> states;  ///< empty = all
  std::string owner;                 ///< empty = all
  std::int64_t limit = 50;
  std::int64_t before = 0;  ///< only jobs submitted before the one of this number; 0 = all
};

struct JobPage {
  std::vector<v1::Job> jobs;  ///< newest first, without finished positions
  std::int64_t next = 0;      ///< ListFilter::before for the jobs after these; 0 = there are none
};

/// Numbers of jobs are never given twice, so that a page begins at the same place whatever comes and goes.
JobPage list_jobs(Database& db, const ListFilter& filter);

/// What ranges that are done are made of.
enum class Done {
  kDirections,  ///< positions in the order of work
  kPoints,      ///< points, in the present round of the refinement
};

/// Finished ranges of an erosion in ascending order.
std::vector<Range> done_ranges(Database& db, std::int64_t erosion_id, Done of = Done::kDirections);

/// What is left of `block`.
std::vector<Range> remaining_ranges(Database& db, std::int64_t erosion_id, Range block,
                                    Done of = Done::kDirections);

/// Adds one finished range, keeping the stored ones disjoint and coalesced.  Returns how many of its
/// positions were new.
std::int64_t add_done_range(Database& db, std::int64_t erosion_id, Range range, Done of = Done::kDirections);

}  // namespace affskel::server

#include "store/rows.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "base/quoted.h"
#include "database/errors.h"
#include "wire/version.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

template <typename Enum>
Enum value_of(const std::string& word) {
  if (const auto value = wire::value_of_word<Enum>(word)) return *value;
  throw StoreError(StoreError::Code::kUnusable, "unknown state '" + word + "' in the database");
}

// In the order in which read_job takes them.
constexpr const char* kJobColumns =
    "SELECT j.seq, j.erosion_id, j.id, j.name, j.owner, j.priority, j.state, j.stage, e.params, j.skeleton,"
    " e.mesh_sha256, e.mesh_bytes, e.prepared, e.directions_done, e.directions, j.created_ms, j.started_ms,"
    " j.finished_ms, j.error_code, j.error_message, j.error_line, j.directions_reported,"
    " j.directions_repeated,"
    " j.reports, j.leases_granted, j.leases_lost, j.longest_gap_ms, j.directions_lost, j.cancel_requested,"
    " j.skeleton_points, e.stride, j.quality, j.pinned, j.removed_ms, j.expires_ms,"
    " iif(EXISTS (SELECT 1 FROM tasks INDEXED BY tasks_in_need WHERE job_id = j.id AND state = 'pending'"
    " AND parked = 0 AND needs_memory > 0),"
    " (SELECT min(needs_memory) FROM tasks WHERE job_id = j.id AND state = 'pending' AND parked = 0), 0),"
    " e.core_version, j.stance_up, j.stance_front, e.round, e.refined_points"
    " FROM jobs j JOIN erosions e ON e.id = j.erosion_id ";

/// Part of a job.  One that cannot be read is told as the job's error: lists and leases of others go on.
void parse_part(google::protobuf::MessageLite& part, std::string_view bytes, v1::Job& job) {
  if (part.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) return;
  part.Clear();
  job.mutable_error()->set_code(kDamagedCode);
  job.mutable_error()->set_message("what the database holds of this job cannot be read");
}

void read_error(Columns& columns, v1::Job& job) {
  const std::optional<std::string> code = columns.text_or_null();
  v1::JobError error;
  error.set_message(columns.text());
  error.set_line(columns.natural());
  if (!code || job.has_error()) return;
  error.set_code(*code);
  *job.mutable_error() = error;
}

void read_counters(Columns& columns, v1::JobCounters& counters) {
  counters.set_directions_reported(columns.natural());
  counters.set_directions_repeated(columns.natural());
  counters.set_reports(columns.natural());
  counters.set_leases_granted(columns.natural());
  counters.set_leases_lost(columns.natural());
  counters.set_longest_report_gap_ms(columns.natural());
  counters.set_directions_lost_estimate(columns.real());
}

void read_stance(Columns& columns, v1::Job& job) {
  v1::Stance stance;
  stance.set_up(static_cast<v1::AxisDirection>(columns.integer()));
  stance.set_front(static_cast<v1::AxisDirection>(columns.integer()));
  if (stance.up() != v1::AXIS_DIRECTION_UNSPECIFIED) *job.mutable_stance() = stance;
}

/// A job as it is sent, and what it is found by.
struct ReadJob {
  std::int64_t seq = 0;
  std::int64_t erosion_id = 0;
  v1::Job job;
};

ReadJob read_job(const Statement& row) {
  Columns columns(row);
  ReadJob read;
  read.seq = columns.integer();
  read.erosion_id = columns.integer();
  v1::Job& job = read.job;
  job.set_id(columns.text());
  job.set_name(columns.text());
  job.set_owner(columns.text());
  job.set_priority(static_cast<std::uint32_t>(columns.integer()));
  job.set_state(value_of<v1::JobState>(columns.text()));
  job.set_stage(value_of<v1::JobStage>(columns.text()));
  parse_part(*job.mutable_params(), columns.blob(), job);
  parse_part(*job.mutable_skeleton(), columns.blob(), job);
  job.set_mesh_sha256(columns.text());
  job.set_mesh_bytes(columns.natural());
  if (const auto prepared = columns.blob_or_null()) parse_part(*job.mutable_prepared(), *prepared, job);
  job.set_directions_done(columns.natural());
  job.set_directions_total(columns.natural());
  job.set_created_ms(columns.natural());
  job.set_started_ms(columns.natural());
  job.set_finished_ms(columns.natural());
  read_error(columns, job);
  read_counters(columns, *job.mutable_counters());
  job.set_cancel_requested(columns.flag());
  job.set_skeleton_points(columns.natural());
  job.set_order_stride(columns.natural());
  if (const auto quality = columns.blob_or_null()) parse_part(*job.mutable_quality(), *quality, job);
  job.set_pinned(columns.flag());
  job.set_removed_ms(columns.natural());
  job.set_expires_ms(columns.natural());
  job.set_memory_needed(columns.natural());
  job.set_core_version(columns.text());
  read_stance(columns, job);
  job.set_refine_round(static_cast<std::uint32_t>(columns.natural()));
  job.set_refined_points(columns.natural());
  return read;
}

/// An id or a prefix, in the form in which ids are kept.
std::string checked_prefix(const std::string& text) {
  std::string reference = text;
  for (char& c : reference) {
    if (c >= 'A' && c <= 'F') c = static_cast<char>(c - 'A' + 'a');
  }
  const bool hex = std::all_of(reference.begin(), reference.end(),
                               [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
  if (reference.size() < 6 || reference.size() > 32 || !hex) {
    throw StoreError(
        StoreError::Code::kInvalid,
        "job " + base::quoted(text) +
            ": expected an id of 32 hexadecimal digits, a prefix of at least 6 of them, or @last");
  }
  return reference;
}

std::optional<JobRow> find_job(Database& db, const std::string& id) {
  Statement row = db.query(
      "SELECT j.state, j.stage, j.cancel_requested, j.erosion_id, j.skeleton, j.skeleton_key, e.mesh_sha256,"
      " e.params_key, e.core_version, e.points, e.directions, e.directions_done, e.finished, j.owner, "
      "j.finished_ms, j.pinned, j.removed_ms, e.refines, e.round, e.refined_points"
      " FROM jobs j JOIN erosions e ON e.id = j.erosion_id WHERE j.id = ?",
      id);
  if (!row.step()) return std::nullopt;
  Columns columns(row);
  JobRow job;
  job.id = id;
  job.state = value_of<v1::JobState>(columns.text());
  job.stage = value_of<v1::JobStage>(columns.text());
  job.cancel_requested = columns.flag();
  job.erosion_id = columns.integer();
  job.skeleton = columns.blob();
  job.skeleton_key = columns.text();
  job.mesh_sha256 = columns.text();
  job.params_key = columns.text();
  job.core_version = columns.text();
  job.points = columns.integer();
  job.directions = columns.integer();
  job.directions_done = columns.integer();
  job.finished = columns.flag();
  job.owner = columns.text();
  job.finished_ms = columns.integer();
  job.pinned = columns.flag();
  job.removed_ms = columns.integer();
  job.refines = columns.flag();
  job.round = columns.integer();
  job.refined_points = columns.integer();
  return job;
}

/// The job that was last told to a submitter of this owner ("" = of any): the newest, unless one was
/// submitted again since.
std::optional<std::string> last_job(Database& db, const std::string& owner) {
  Statement repeated = db.query(
      "SELECT j.id FROM server_state s JOIN jobs j ON j.id = s.value WHERE s.key = 'repeated_job/' || ?",
      owner);
  if (repeated.step()) return repeated.text(0);
  Statement row = owner.empty()
                      ? db.query("SELECT id FROM jobs ORDER BY seq DESC LIMIT 1")
                      : db.query("SELECT id FROM jobs WHERE owner = ? ORDER BY seq DESC LIMIT 1", owner);
  if (!row.step()) return std::nullopt;
  return row.text(0);
}

// Fields of different core versions are never mixed, so a job begun by one version waits for it.
std::string missing_core(Database& db, const std::string& id) {
  Statement row = db.query(
      "SELECT e.core_version FROM jobs j JOIN erosions e ON e.id = j.erosion_id"
      " WHERE j.id = ? AND j.stage IN ('erode', 'refine') AND j.state IN ('queued', 'running')"
      " AND NOT EXISTS (SELECT 1 FROM tasks WHERE job_id = j.id AND state = 'leased')",
      id);
  if (!row.step()) return {};
  const std::string needed = row.text(0);
  const std::string current = current_core_version(db);
  if (current.empty() || current == needed) return {};
  return "begun with core version " + needed + ", the workers now have version " + current +
         "; connect such a worker, or cancel the job and submit it anew";
}

struct RangeSql {
  const char *all, *touching, *remove, *insert;
};

#define RANGES_OF(table)                                                                               \
  RangeSql {                                                                                           \
    "SELECT first_position, end_position FROM " table " WHERE erosion_id = ? ORDER BY first_position", \
        "SELECT first_position, end_position FROM " table                                              \
        " WHERE erosion_id = ? AND first_position <= ? AND end_position >= ?",                         \
        "DELETE FROM " table " WHERE erosion_id = ? AND first_position >= ? AND first_position <= ?",  \
        "INSERT INTO " table " (erosion_id, first_position, end_position) VALUES (?, ?, ?)"            \
  }

const RangeSql& range_sql(Done of) {
  static constexpr RangeSql directions = RANGES_OF("done_ranges"), points = RANGES_OF("refined_ranges");
  return of == Done::kDirections ? directions : points;
}

}  // namespace

JobRow get_job(Database& db, const std::string& id) {
  std::optional<JobRow> job = find_job(db, id);
  if (!job) throw StoreError(StoreError::Code::kNotFound, "no job " + id);
  return *std::move(job);
}

std::string resolve_job(Database& db, const JobRef& reference) {
  if (reference.text == "@last") {
    if (std::optional<std::string> id = last_job(db, reference.owner)) return *std::move(id);
    throw StoreError(StoreError::Code::kNotFound, "no job @last: there are no jobs");
  }
  const std::string prefix = checked_prefix(reference.text);
  // 'g' follows the last hexadecimal digit, so this range is exactly the ids that begin so.
  Statement row = db.query(
      "SELECT id FROM jobs WHERE id >= ?1 AND id < ?1 || 'g' AND (owner = ?2 OR NOT ?3) ORDER BY id LIMIT 2",
      prefix, reference.owner, reference.own_only);
  if (!row.step()) throw StoreError(StoreError::Code::kNotFound, "no job " + prefix);
  std::string id = row.text(0);
  if (row.step()) {
    throw StoreError(StoreError::Code::kInvalid, "job '" + prefix + "': more than one job's id begins so");
  }
  return id;
}

v1::Job job_message(Database& db, const std::string& id) {
  static const std::string sql = std::string(kJobColumns) + "WHERE j.id = ?";
  Statement row = db.query(sql.c_str(), id);
  if (!row.step()) throw StoreError(StoreError::Code::kNotFound, "no job " + id);
  ReadJob read = read_job(row);
  v1::Job& job = read.job;
  for (const Range& range : done_ranges(db, read.erosion_id)) {
    v1::PositionRange* done = job.add_done_positions();
    done->set_begin(static_cast<std::uint64_t>(range.begin));
    done->set_end(static_cast<std::uint64_t>(range.end));
  }
  job.set_waiting_reason(missing_core(db, id));
  Statement repair = db.query("SELECT report FROM repairs WHERE job_id = ?", id);
  if (repair.step()) parse_part(*job.mutable_repair(), repair.blob(0), job);
  return std::move(job);
}

JobPage list_jobs(Database& db, const ListFilter& filter) {
  // States as a bit set, so that one statement serves every filter.
  std::int64_t mask = filter.states.empty() ? -1 : 0;
  for (v1::JobState state : filter.states) mask |= std::int64_t{1} << static_cast<int>(state);
  // With an owner a step in the index of his jobs, without one in that of all.
  static const std::string rest =
      " AND (?2 >> CASE j.state WHEN 'queued' THEN 1 WHEN 'running' THEN 2"
      " WHEN 'done' THEN 3 WHEN 'failed' THEN 4 ELSE 5 END) & 1 AND j.seq < ?4 ORDER BY j.seq DESC LIMIT ?3";
  static const std::string of_all = std::string(kJobColumns) + "WHERE ?1 = ''" + rest;
  static const std::string of_one = std::string(kJobColumns) + "WHERE j.owner = ?1" + rest;
  const std::string& sql = filter.owner.empty() ? of_all : of_one;
  const std::int64_t before = filter.before > 0 ? filter.before : std::numeric_limits<std::int64_t>::max();
  Statement row = db.query(sql.c_str(), filter.owner, mask, filter.limit + 1, before);
  JobPage page;
  std::int64_t last = 0;
  while (row.step()) {
    if (static_cast<std::int64_t>(page.jobs.size()) == filter.limit) {
      page.next = last;
      break;
    }
    ReadJob read = read_job(row);
    last = read.seq;
    page.jobs.push_back(std::move(read.job));
  }
  return page;
}

std::string database_id(Database& db) {
  Statement row = db.query("SELECT value FROM server_state WHERE key = 'database'");
  return row.step() ? row.text(0) : std::string();
}

std::string field_name(Database& db, std::int64_t erosion_id) {
  return database_id(db) + "/" + std::to_string(erosion_id) + "." +
         std::to_string(db.integer("SELECT revision FROM erosions WHERE id = ?", erosion_id).value_or(0));
}

std::string current_core_version(Database& db) {
  // Remembered with the version of the programs: after an upgrade the old answer says nothing.
  Statement row = db.query("SELECT value FROM server_state WHERE key = 'core_version/' || ?", wire::kVersion);
  return row.step() ? row.text(0) : std::string();
}

std::vector<Range> done_ranges(Database& db, std::int64_t erosion_id, Done of) {
  Statement row = db.query(range_sql(of).all, erosion_id);
  std::vector<Range> ranges;
  while (row.step()) ranges.push_back({row.integer(0), row.integer(1)});
  return ranges;
}

std::vector<Range> remaining_ranges(Database& db, std::int64_t erosion_id, Range block, Done of) {
  std::vector<Range> left;
  std::int64_t at = block.begin;
  for (const Range& done : done_ranges(db, erosion_id, of)) {
    if (done.end <= at) continue;
    if (done.begin >= block.end) break;
    if (done.begin > at) left.push_back({at, done.begin});
    at = done.end;
  }
  if (at < block.end) left.push_back({at, block.end});
  return left;
}

std::int64_t add_done_range(Database& db, std::int64_t erosion_id, Range range, Done of) {
  Range joined = range;
  std::int64_t repeated = 0;
  {
    Statement row = db.query(range_sql(of).touching, erosion_id, range.end, range.begin);
    while (row.step()) {
      const Range old{row.integer(0), row.integer(1)};
      repeated += std::max<std::int64_t>(0, std::min(old.end, range.end) - std::max(old.begin, range.begin));
      joined = {std::min(joined.begin, old.begin), std::max(joined.end, old.end)};
    }
  }
  const std::int64_t added = range.end - range.begin - repeated;
  if (added == 0) return 0;
  db.run(range_sql(of).remove, erosion_id, joined.begin, joined.end);
  db.run(range_sql(of).insert, erosion_id, joined.begin, joined.end);
  return added;
}

}  // namespace affskel::server

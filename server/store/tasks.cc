#include "store/tasks.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include "base/number_text.h"
#include "database/errors.h"
#include "metrics/metrics.h"
#include "store/blobs.h"
#include "store/field.h"
#include "store/job_events.h"
#include "store/memory_need.h"
#include "store/verification.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

v1::TaskKind kind_of(const std::string& name) {
  if (const auto kind = wire::value_of_word<v1::TaskKind>(name)) return *kind;
  throw StoreError(StoreError::Code::kUnusable, "unknown kind of task '" + name + "' in the database");
}

constexpr const char* kTaskColumns =
    "SELECT id, job_id, kind, state, on_request, first_position, end_position, params, params_key, losses,"
    " worker, host, core_version, granted_ms, reported_ms, lease_directions FROM tasks ";

TaskRow read_task(const Statement& row) {
  Columns columns(row);
  TaskRow task;
  task.id = columns.integer();
  task.job_id = columns.text();
  task.kind = kind_of(columns.text());
  task.state = columns.text();
  task.on_request = columns.flag();
  task.block.begin = columns.integer();
  task.block.end = columns.integer();
  task.params = columns.blob();
  task.params_key = columns.text();
  task.losses = columns.integer();
  task.worker = columns.text();
  task.host = columns.text();
  task.core_version = columns.text();
  task.granted_ms = columns.integer();
  task.reported_ms = columns.integer_or_null();
  task.lease_directions = columns.integer();
  return task;
}

// A block may be silent about positions for this many times its job's longest pause between two reports, and
// for a millisecond for so many points of its field: directions take microseconds per point, rarely more.
constexpr std::int64_t kGapsWithoutProgress = 10;
constexpr std::int64_t kPointsPerPatientMs = 10;

// A request that has failed is kept so long for whoever waits for it.
constexpr std::int64_t kFailedRequestMs = 60'000;

void clear_lease(Tx& tx, const TaskRow& task, const char* state) {
  tx.db.run(
      "UPDATE tasks SET state = ?, token = NULL, late_token = NULL, worker = NULL, host = NULL, pid = NULL,"
      " supervised = NULL, core_version = NULL, granted_ms = NULL, reported_ms = NULL, deadline_ms = NULL,"
      " stalled_ms = NULL, lease_directions = 0 WHERE id = ?",
      state, task.id);
  tx.changes.jobs.insert(task.job_id);
  tx.changes.work = true;
}

/// Directions per millisecond: of the lease once it has reported, else of the job since it was started (by
/// all its workers, so rather too many).
double rate_of(const Tx& tx, const TaskRow& task) {
  if (task.reported_ms && *task.reported_ms > task.granted_ms) {
    return static_cast<double>(task.lease_directions) /
           static_cast<double>(*task.reported_ms - task.granted_ms);
  }
  const std::int64_t started =
      tx.db.integer("SELECT started_ms FROM jobs WHERE id = ?", task.job_id).value_or(tx.wall_ms);
  const std::int64_t reported =
      tx.db.integer("SELECT directions_reported FROM jobs WHERE id = ?", task.job_id).value_or(0);
  if (started == 0 || tx.wall_ms <= started) return 0;
  return static_cast<double>(reported) / static_cast<double>(tx.wall_ms - started);
}

/// Directions that were probably computed and never reported: the rate over the time since the last report
/// or the grant, but no longer than the interval at which the worker would have reported.
double lost_directions(const Tx& tx, const TaskRow& task) {
  if (task.kind != v1::TASK_KIND_ERODE) return 0;
  const std::int64_t heard = task.reported_ms.value_or(task.granted_ms);
  const std::int64_t silence =
      std::clamp<std::int64_t>(tx.lease_ms - heard, 0, tx.options.report_interval_ms);
  return rate_of(tx, task) * static_cast<double>(silence);
}

/// The job has come to its end, or to a stop.
void tell_end(Tx& tx, const JobRow& job, v1::JobState state, std::string message) {
  const std::string word = wire::word(state);
  add_event(tx, job.id, {.event = word, .message = std::move(message)});
  tx.changes.counts.push_back([word](Metrics& metrics) { metrics.job_ended(word); });
}

std::string progress_text(const JobRow& job) {
  return std::to_string(job.directions_done) + " of " + base::counted(job.directions, "direction");
}

/// Merges what is logged.  False when some of it is damaged: the job has failed, and what was merged so far
/// stays, for it is true.
bool settle_or_fail(Tx& tx, const JobRow& job) {
  v1::JobError error;
  error.set_code("DAMAGED");
  try {
    settle_field(tx.db, job.erosion_id, job.points);
    return true;
  } catch (const StoreError& damaged) {
    if (damaged.code() != StoreError::Code::kDamaged) throw;
    error.set_message(damaged.what());
  }
  fail_job(tx, job.id, error);
  return false;
}

/// All blocks done: the field is complete.  False when it is damaged.
bool finish_erosion(Tx& tx, JobRow& job) {
  if (job.directions_done != job.directions) {
    throw StoreError(StoreError::Code::kUnusable, "job " + job.id + ": all blocks are done, but only " +
                                                      std::to_string(job.directions_done) + " of " +
                                                      std::to_string(job.directions) + " directions");
  }
  if (!settle_or_fail(tx, job)) return false;
  tx.db.run("UPDATE erosions SET finished = 1 WHERE id = ?", job.erosion_id);
  end_stage(tx, job.id);
  tx.db.run("UPDATE jobs SET stage = 'derive' WHERE id = ?", job.id);
  job.finished = true;
  job.stage = v1::JOB_STAGE_DERIVE;
  add_event(tx, job.id, {.event = "eroded", .message = progress_text(job)});
  return true;
}

/// The default skeleton is stored, or a task for it is there.  True when the job is done.
bool finish_derive(Tx& tx, const JobRow& job) {
  const std::optional<std::int64_t> skeleton =
      find_artifact(tx.db, {job.erosion_id, "skeleton", job.skeleton_key});
  if (!skeleton) {
    if (!tx.db.integer("SELECT 1 FROM tasks WHERE job_id = ? AND kind = 'skeleton' AND on_request = 0",
                       job.id)) {
      add_derive_task(tx, job.id, v1::TASK_KIND_SKELETON, job.skeleton, job.skeleton_key, false);
    }
    return false;
  }
  end_stage(tx, job.id);
  tx.db.run(
      "UPDATE jobs SET state = 'done', stage = 'complete', finished_ms = ?, cancel_requested = 0,"
      " (skeleton_points, quality) = (SELECT items, quality FROM artifacts WHERE id = ?) WHERE id = ?",
      tx.wall_ms, *skeleton, job.id);
  // A skeleton that another job of the same field has brought meanwhile need not be made again.
  tx.db.run(
      "DELETE FROM tasks WHERE job_id = ? AND kind = 'skeleton' AND on_request = 0 AND state = 'pending'",
      job.id);
  tell_end(tx, job, v1::JOB_STATE_DONE, "");
  return true;
}

}  // namespace

std::optional<TaskRow> find_task(Database& db, std::int64_t id) {
  static const std::string sql = std::string(kTaskColumns) + "WHERE id = ?";
  Statement row = db.query(sql.c_str(), id);
  if (!row.step()) return std::nullopt;
  return read_task(row);
}

std::optional<TaskRow> find_task_of_token(Database& db, const std::string& token) {
  static const std::string sql = std::string(kTaskColumns) + "WHERE token = ?1 OR late_token = ?1";
  Statement row = db.query(sql.c_str(), token);
  if (!row.step()) return std::nullopt;
  return read_task(row);
}

TaskRow task_of_token(Database& db, const std::string& token) {
  if (std::optional<TaskRow> task = find_task_of_token(db, token)) return *std::move(task);
  throw StoreError(StoreError::Code::kFenced, "the lease has ended; its work goes on elsewhere");
}

namespace {

/// What a new task has beside its job.
struct NewTask {
  v1::TaskKind kind = v1::TASK_KIND_UNSPECIFIED;
  bool on_request = false;
  std::optional<Range> block;  // ERODE
  std::optional<Blob> params;  // of the derived kinds
  std::optional<std::string> params_key;
};

/// Adds a task in its place in the queue: what decides it is copied from the job, see migrations 5 and 8.
std::int64_t enqueue(Tx& tx, const std::string& job_id, const NewTask& task) {
  const auto position = [&](std::int64_t Range::*end) {
    return task.block ? std::optional((*task.block).*end) : std::nullopt;
  };
  const std::string params(task.params ? task.params->bytes : std::string_view());
  tx.db.run(
      "INSERT INTO tasks (job_id, kind, state, on_request, first_position, end_position, params, params_key,"
      " seq, priority, owner, turn, parked, needs_memory, needs_core)"
      " SELECT j.id, ?2, 'pending', ?3, ?4, ?5, ?6, ?7, j.seq, j.priority, j.owner,"
      "  ifnull((SELECT max(turn) FROM tasks WHERE job_id = j.id), 0),"
      "  ?2 = 'verify' OR ?3 = 0 AND (j.state NOT IN ('queued', 'running') OR j.cancel_requested = 1), ?8,"
      "  iif(?2 IN ('erode', 'verify') OR (?2 = 'prepare' AND ?3 = 1), ifnull(e.core_version, ''), '')"
      " FROM jobs j JOIN erosions e ON e.id = j.erosion_id WHERE j.id = ?1",
      job_id, wire::word(task.kind), task.on_request, position(&Range::begin), position(&Range::end),
      task.params, task.params_key, memory_need_of(tx.db, job_id, task.kind, params));
  tx.changes.work = true;
  return tx.db.last_insert_rowid();
}

}  // namespace

std::int64_t add_task(Tx& tx, const std::string& job_id, v1::TaskKind kind) {
  NewTask task;
  task.kind = kind;
  return enqueue(tx, job_id, task);
}

std::int64_t add_prepare_request(Tx& tx, const std::string& job_id) {
  NewTask task;
  task.kind = v1::TASK_KIND_PREPARE;
  task.on_request = true;
  return enqueue(tx, job_id, task);
}

std::int64_t add_block(Tx& tx, const std::string& job_id, Range block) {
  NewTask task;
  task.kind = v1::TASK_KIND_ERODE;
  task.block = block;
  return enqueue(tx, job_id, task);
}

std::int64_t add_derive_task(Tx& tx, const std::string& job_id, v1::TaskKind kind, const std::string& params,
                             const std::string& params_key, bool on_request) {
  return enqueue(tx, job_id, {kind, on_request, std::nullopt, Blob{params}, params_key});
}

std::int64_t add_sample_task(Tx& tx, const std::string& job_id, const std::string& positions,
                             std::int64_t sample) {
  return enqueue(tx, job_id,
                 {v1::TASK_KIND_VERIFY, true, std::nullopt, Blob{positions}, std::to_string(sample)});
}

std::int64_t patience_ms(Tx& tx, const TaskRow& task) {
  if (task.kind != v1::TASK_KIND_ERODE) return tx.options.long_stall_ms;
  // A direction of a huge scan takes minutes: the limit follows from the job's reports or, before these, from
  // its points.
  const std::int64_t longest_gap =
      tx.db.integer("SELECT longest_gap_ms FROM jobs WHERE id = ?", task.job_id).value_or(0);
  const std::int64_t points =
      tx.db
          .integer("SELECT e.points FROM erosions e JOIN jobs j ON j.erosion_id = e.id WHERE j.id = ?",
                   task.job_id)
          .value_or(0);
  return std::max({tx.options.stall_ms, kGapsWithoutProgress * longest_gap, points / kPointsPerPatientMs});
}

TaskRow held_task(Tx& tx, const std::string& token) {
  return resume_if_late(tx, task_of_token(tx.db, token));
}

TaskRow resume_if_late(Tx& tx, TaskRow task) {
  if (task.state != "pending") return task;
  tx.db.run(
      "UPDATE tasks SET state = 'leased', token = late_token, late_token = NULL, deadline_ms = ?,"
      " stalled_ms = ? WHERE id = ?",
      tx.lease_ms + tx.options.lease_ms, tx.lease_ms + patience_ms(tx, task), task.id);
  task.state = "leased";
  tx.db.run("UPDATE jobs SET directions_lost = max(0.0, directions_lost - ?) WHERE id = ?",
            lost_directions(tx, task), task.job_id);
  tx.changes.jobs.insert(task.job_id);
  add_event(tx, task.job_id,
            task_event("lease_resumed", task, "its worker is back, and no other had taken it"));
  return task;
}

void renew_lease(Tx& tx, const TaskRow& task) {
  tx.db.run("UPDATE tasks SET deadline_ms = ? WHERE id = ?", tx.lease_ms + tx.options.lease_ms, task.id);
}

void finish_task(Tx& tx, const TaskRow& task) {
  tx.db.run("UPDATE tasks SET state = 'done', losses = 0, deadline_ms = NULL, stalled_ms = NULL WHERE id = ?",
            task.id);
  tx.changes.jobs.insert(task.job_id);
  add_event(tx, task.job_id, task_event("finished", task));
  const std::chrono::milliseconds time(task.state == "leased" ? tx.lease_ms - task.granted_ms : 0);
  tx.changes.counts.push_back(
      [kind = wire::word(task.kind), time](Metrics& metrics) { metrics.task_finished(kind, time); });
}

namespace {

/// Finishes a block of which nothing is left.
bool finish_if_whole(Tx& tx, const TaskRow& task) {
  if (task.kind != v1::TASK_KIND_ERODE) return false;
  const JobRow job = get_job(tx.db, task.job_id);
  if (!remaining_ranges(tx.db, job.erosion_id, task.block).empty()) return false;
  finish_task(tx, task);
  return true;
}

/// Offers the work of a silent worker to all, with its lease left in the row: see held_task().
void offer_to_others(Tx& tx, const TaskRow& task) {
  if (finish_if_whole(tx, task)) return;
  tx.db.run(
      "UPDATE tasks SET state = 'pending', late_token = token, token = NULL, deadline_ms = NULL,"
      " stalled_ms = NULL WHERE id = ?",
      task.id);
  tx.changes.jobs.insert(task.job_id);
  tx.changes.work = true;
}

/// The lease has ended without progress.
void count_ended(Tx& tx, const TaskRow& task, const v1::JobError& error) {
  // Nothing counts against a block that turned out to be finished.
  const bool left =
      tx.db.run("UPDATE tasks SET losses = losses + 1 WHERE id = ? AND state = 'pending'", task.id) > 0;
  if (left && task.losses + 1 >= tx.options.max_losses) give_up(tx, task, error);
  settle_job(tx, task.job_id);
}

}  // namespace

void release_task(Tx& tx, const TaskRow& task) {
  if (!finish_if_whole(tx, task)) clear_lease(tx, task, "pending");
}

void release_all_leases(Tx& tx) {
  std::vector<TaskRow> leased;
  {
    static const std::string sql = std::string(kTaskColumns) + "WHERE state = 'leased'";
    Statement row = tx.db.query(sql.c_str());
    while (row.step()) leased.push_back(read_task(row));
  }
  for (const TaskRow& task : leased) release_task(tx, task);
  // A report that is repeated must not be taken for one that is known already, nor a late worker come back.
  tx.db.run(
      "UPDATE tasks SET token = NULL, late_token = NULL WHERE token IS NOT NULL OR late_token IS NOT NULL");
}

void lose_lease(Tx& tx, const TaskRow& task, const std::string& why, bool may_come_back) {
  tx.db.run(
      "UPDATE jobs SET leases_lost = leases_lost + 1, directions_lost = directions_lost + ? WHERE id = ?",
      lost_directions(tx, task), task.job_id);
  add_event(tx, task.job_id, task_event("lease_lost", task, why));
  tx.changes.counts.push_back([kind = wire::word(task.kind)](Metrics& metrics) { metrics.lease_lost(kind); });
  v1::JobError error;
  error.set_code("WORKER_LOST");
  error.set_message("the " + wire::word(task.kind) + " task lost its worker " +
                    std::to_string(task.losses + 1) + " times in a row without any progress (last: " + why +
                    "); see the workers' logs, a worker may run out of memory");
  if (may_come_back) {
    offer_to_others(tx, task);
  } else {
    release_task(tx, task);
  }
  count_ended(tx, task, error);
}

void count_loss(Tx& tx, const TaskRow& task, const v1::JobError& error) {
  release_task(tx, task);
  count_ended(tx, task, error);
}

void give_up(Tx& tx, const TaskRow& task, const v1::JobError& error) {
  clear_lease(tx, task, "pending");
  if (task.on_request) {
    tx.db.run(
        "UPDATE tasks SET state = 'failed', error_code = ?, error_message = ?, deadline_ms = ?"
        " WHERE id = ?",
        error.code(), error.message(), tx.lease_ms + kFailedRequestMs, task.id);
    if (task.kind == v1::TASK_KIND_VERIFY) fail_sample(tx, task, error.code() + ": " + error.message());
    add_event(tx, task.job_id, task_event("request_failed", task, error.code() + ": " + error.message()));
    return;
  }
  fail_job(tx, task.job_id, error);
}

void fail_job(Tx& tx, const std::string& job_id, const v1::JobError& error) {
  const JobRow job = get_job(tx.db, job_id);
  if (!job.active()) return;
  tx.db.run(
      "UPDATE jobs SET state = 'failed', finished_ms = ?, cancel_requested = 0, error_code = ?,"
      " error_message = ?, error_line = ? WHERE id = ?",
      tx.wall_ms, error.code(), error.message(), error.line(), job_id);
  tx.changes.jobs.insert(job_id);
  tell_end(tx, job, v1::JOB_STATE_FAILED, error.code() + ": " + error.message());
}

void end_stage(Tx& tx, const std::string& job_id) {
  {
    Statement row = tx.db.query("SELECT stage, stage_ms FROM jobs WHERE id = ?", job_id);
    if (row.step() && row.integer(1) != 0) {
      // The clock on the wall may have been put back.
      const std::chrono::milliseconds time(std::max<std::int64_t>(0, tx.wall_ms - row.integer(1)));
      tx.changes.counts.push_back(
          [stage = row.text(0), time](Metrics& metrics) { metrics.stage_ended(stage, time); });
    }
  }
  tx.db.run("UPDATE jobs SET stage_ms = ? WHERE id = ?", tx.wall_ms, job_id);
}

void settle_job(Tx& tx, const std::string& job_id) {
  tx.changes.jobs.insert(job_id);
  JobRow job = get_job(tx.db, job_id);
  if (!job.active()) return;
  const bool blocks_left =
      tx.db
          .integer("SELECT 1 FROM tasks WHERE job_id = ? AND kind = 'erode' AND state <> 'done' LIMIT 1",
                   job_id)
          .has_value();
  // That may write the whole field, for which a full disk has no room: see settle_finished_blocks().
  if (job.stage == v1::JOB_STAGE_ERODE && !blocks_left && tx.room && !finish_erosion(tx, job)) return;
  if (job.stage == v1::JOB_STAGE_DERIVE && finish_derive(tx, job)) return;
  if (!job.cancel_requested) return;
  if (tx.db.integer("SELECT 1 FROM tasks WHERE job_id = ? AND state = 'leased' AND on_request = 0 LIMIT 1",
                    job_id)) {
    return;
  }
  tx.db.run("UPDATE jobs SET state = 'cancelled', cancel_requested = 0, finished_ms = ? WHERE id = ?",
            tx.wall_ms, job_id);
  tell_end(tx, job, v1::JOB_STATE_CANCELLED, progress_text(job));
}

void finish_whole_blocks(Tx& tx, const std::string& job_id) {
  tx.db.run(
      "UPDATE tasks SET state = 'done' WHERE job_id = ? AND kind = 'erode' AND state = 'pending' AND EXISTS"
      " (SELECT 1 FROM done_ranges r JOIN jobs j ON j.erosion_id = r.erosion_id WHERE j.id = tasks.job_id"
      "  AND r.first_position <= tasks.first_position AND r.end_position >= tasks.end_position)",
      job_id);
}

void settle_finished_blocks(Tx& tx) {
  std::vector<std::string> jobs;
  {
    Statement row = tx.db.query(
        "SELECT id FROM jobs j WHERE state IN ('queued', 'running') AND stage = 'erode' AND NOT EXISTS"
        " (SELECT 1 FROM tasks WHERE job_id = j.id AND kind = 'erode' AND state <> 'done')");
    while (row.step()) jobs.push_back(row.text(0));
  }
  for (const std::string& job : jobs) settle_job(tx, job);
}

}  // namespace affskel::server

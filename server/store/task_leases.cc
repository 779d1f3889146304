#include "store/task_leases.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "database/errors.h"
#include "metrics/metrics.h"
#include "store/field.h"
#include "store/job_events.h"
#include "store/job_life.h"
#include "store/space.h"
#include "store/verification.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

// A block may be silent about positions for this many times its job's longest pause between two reports, and
// for a millisecond for so many points of its field: directions take microseconds per point, rarely more.
constexpr std::int64_t kGapsWithoutProgress = 10;
constexpr std::int64_t kPointsPerPatientMs = 10;

// A request that has failed is kept so long for the calls that wait for it.
constexpr std::int64_t kFailedRequestMs = 60'000;

void clear_lease(Tx& tx, const TaskRow& task, const char* state) {
  tx.db.run(
      "UPDATE tasks SET state = ?, token = NULL, late_token = NULL, worker = NULL, host = NULL, pid = NULL,"
      " supervised = NULL, core_version = NULL, granted_ms = NULL, reported_ms = NULL, deadline_ms = NULL,"
      " stalled_ms = NULL, waited_ms = NULL, lease_directions = 0 WHERE id = ?",
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
/// or the grant, but no longer than the interval at which the worker would have reported, and no more than are left.
double lost_directions(const Tx& tx, const TaskRow& task) {
  if (task.kind != v1::TASK_KIND_ERODE) return 0;
  const std::int64_t heard = task.reported_ms.value_or(task.granted_ms);
  const std::int64_t silence =
      std::clamp<std::int64_t>(tx.lease_ms - heard, 0, tx.options.report_interval_ms);
  double left = 0;
  for (const Range& range : left_of_block(tx.db, get_job(tx.db, task.job_id), task))
    left += static_cast<double>(range.end - range.begin);
  return std::min(left, rate_of(tx, task) * static_cast<double>(silence));
}

/// A lease that can make no progress at the moment.  Its worker tries several times a second, and every commit takes a
/// little of what is left of the disk: what is written may be half a lease old.
void keep_waiting(Tx& tx, const TaskRow& task) {
  tx.db.run(
      "UPDATE tasks SET deadline_ms = ?1 + ?2, stalled_ms = max(stalled_ms, ?1 + ?3), waited_ms = ?1 WHERE id = ?4"
      " AND (deadline_ms < ?1 + ?2 / 2 OR stalled_ms < ?1 + ?3 / 2"
      "  OR ifnull(waited_ms, 0) < ?1 - ?2 / 2)",
      tx.lease_ms, tx.options.lease_ms, patience_ms(tx, task), task.id);
}

/// Finishes a block of which nothing is left.
bool finish_if_whole(Tx& tx, const TaskRow& task) {
  if (task.kind != v1::TASK_KIND_ERODE && task.kind != v1::TASK_KIND_REFINE) return false;
  const JobRow job = get_job(tx.db, task.job_id);
  if (!left_of_block(tx.db, job, task).empty()) return false;
  finish_task(tx, task);
  return true;
}

/// Offers the work of a silent worker to all, with its lease left in the row: see held_task().  In the place of the
/// moment at which its patience ends stands what was left of it when the worker was last heard.
void offer_to_others(Tx& tx, const TaskRow& task) {
  if (finish_if_whole(tx, task)) return;
  tx.db.run(
      "UPDATE tasks SET state = 'pending', late_token = token, token = NULL, deadline_ms = NULL,"
      " stalled_ms = max(0, stalled_ms - (deadline_ms - ?)) WHERE id = ?",
      tx.options.lease_ms, task.id);
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

bool is_cancelled(const TaskRow& task, const JobRow& job) {
  return !task.on_request && (!job.active() || job.cancel_requested);
}

std::vector<Range> left_of_block(Database& db, const JobRow& job, const TaskRow& task) {
  const Done of = task.kind == v1::TASK_KIND_REFINE ? Done::kPoints : Done::kDirections;
  return remaining_ranges(db, job.erosion_id, task.block, of);
}

std::int64_t patience_ms(Tx& tx, const TaskRow& task) {
  if (task.kind != v1::TASK_KIND_ERODE && task.kind != v1::TASK_KIND_REFINE) return tx.options.long_stall_ms;
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

std::int64_t pause_ms(Tx& tx, const TaskRow& task) {
  const std::int64_t heard = task.reported_ms.value_or(task.granted_ms);
  const std::int64_t waited =
      tx.db.integer("SELECT ifnull(waited_ms, 0) FROM tasks WHERE id = ?", task.id).value_or(0);
  return tx.lease_ms - std::max(heard, waited);
}

TaskRow held_task(Tx& tx, const std::string& token) {
  return resume_if_late(tx, task_of_token(tx.db, token));
}

TaskRow resume_if_late(Tx& tx, TaskRow task) {
  if (task.state != "pending") return task;
  // Nothing was lost; but whoever is late again and again without any progress comes to the end of the patience.
  const std::int64_t patience =
      tx.db.integer("SELECT stalled_ms FROM tasks WHERE id = ?", task.id).value_or(patience_ms(tx, task));
  tx.db.run(
      "UPDATE tasks SET state = 'leased', token = late_token, late_token = NULL, deadline_ms = ?,"
      " stalled_ms = ?, reported_ms = ?, losses = max(0, losses - 1) WHERE id = ?",
      tx.lease_ms + tx.options.lease_ms, tx.lease_ms + patience, tx.lease_ms, task.id);
  task.state = "leased";
  task.losses = std::max<std::int64_t>(0, task.losses - 1);
  tx.db.run(
      "UPDATE jobs SET leases_lost = max(0, leases_lost - 1),"
      " directions_lost = max(0.0, directions_lost - ?) WHERE id = ?",
      lost_directions(tx, task), task.job_id);
  task.reported_ms = tx.lease_ms;  // its silence is no pause between two reports
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
  // The clock may have been put back since the grant.
  const std::chrono::milliseconds time(
      task.state == "leased" ? std::max<std::int64_t>(0, tx.lease_ms - task.granted_ms) : 0);
  tx.changes.counts.push_back(
      [kind = wire::word(task.kind), time](Metrics& metrics) { metrics.task_finished(kind, time); });
}

void release_task(Tx& tx, const TaskRow& task) {
  if (!finish_if_whole(tx, task)) clear_lease(tx, task, "pending");
}

std::exception_ptr refuse_for_now(Tx& tx, const TaskRow& task) {
  if (task.state == "leased" && is_cancelled(task, get_job(tx.db, task.job_id))) {
    release_task(tx, task);
    settle_job(tx, task.job_id);
    tx.changes.eased = true;
    return std::make_exception_ptr(
        StoreError(StoreError::Code::kFenced, "the job was cancelled while the disk was full"));
  }
  tx.changes.refused = true;
  for (const TaskRow& held : leased_tasks(tx.db))
    if (held.worker == task.worker) keep_waiting(tx, held);
  return std::make_exception_ptr(full_disk(tx.db));
}

void release_all_leases(Tx& tx) {
  for (const TaskRow& task : leased_tasks(tx.db)) release_task(tx, task);
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
                    "); see the workers' logs: it may crash them, or need more memory than they have");
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

}  // namespace affskel::server

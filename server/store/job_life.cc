#include "store/job_life.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "database/errors.h"
#include "metrics/metrics.h"
#include "store/blobs.h"
#include "store/field.h"
#include "store/job_events.h"
#include "store/own_skeleton.h"
#include "store/refinement.h"
#include "store/rows.h"
#include "store/task_rows.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

/// The job has come to its end, or to a stop.
void record_end(Tx& tx, const JobRow& job, v1::JobState state, std::string message) {
  const std::string word = wire::word(state);
  add_event(tx, job.id, {.event = word, .message = std::move(message)});
  tx.changes.counts.push_back([word](Metrics& metrics) { metrics.job_ended(word); });
}

void finish_field(Tx& tx, JobRow& job) {
  tx.db.run("UPDATE erosions SET finished = 1 WHERE id = ?", job.erosion_id);
  end_stage(tx, job.id);
  tx.db.run("UPDATE jobs SET stage = 'derive' WHERE id = ?", job.id);
  job.finished = true;
  job.stage = v1::JOB_STAGE_DERIVE;
}

/// All blocks of directions done: the set's field is complete.
void finish_erosion(Tx& tx, JobRow& job) {
  if (job.directions_done != job.directions) {
    throw StoreError(StoreError::Code::kDamaged, "job " + job.id + ": all blocks are done, but only " +
                                                     std::to_string(job.directions_done) + " of " +
                                                     std::to_string(job.directions) + " directions");
  }
  settle_field(tx.db, job.erosion_id, job.points);
  if (job.refines) {
    end_stage(tx, job.id);
    tx.db.run("UPDATE jobs SET stage = 'refine' WHERE id = ?", job.id);
    job.stage = v1::JOB_STAGE_REFINE;
    begin_refinement(tx, job);
  } else {
    finish_field(tx, job);
  }
  add_event(tx, job.id, {.event = "eroded", .message = progress_text(job)});
}

/// All blocks of a round done: the next one, or the field is complete.
void go_on_refining(Tx& tx, JobRow& job) {
  if (!finish_round(tx, job)) return;
  finish_field(tx, job);
  add_event(tx, job.id, {.event = "refined", .message = "in " + base::counted(job.round + 1, "round")});
}

bool has_blocks_left(Database& db, const JobRow& job) {
  return db
      .integer("SELECT 1 FROM tasks WHERE job_id = ? AND kind = ? AND state <> 'done' LIMIT 1", job.id,
               wire::word(job.stage))
      .has_value();
}

/// The job's own skeleton is stored, or a task for it is there.  True when the job is done.
bool finish_derive(Tx& tx, const JobRow& job) {
  const auto& [kind, params] = own_skeleton(job);
  const std::optional<std::int64_t> skeleton =
      find_artifact(tx.db, {job.erosion_id, kind.name(), params.key});
  if (!skeleton) {
    if (!tx.db.integer("SELECT 1 FROM tasks WHERE job_id = ? AND kind = ? AND on_request = 0", job.id,
                       wire::word(kind.task))) {
      add_derive_task(tx, job.id, kind.task, params.bytes, params.key, false);
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
      "DELETE FROM tasks WHERE job_id = ? AND kind IN ('skeleton', 'surface') AND on_request = 0"
      " AND state = 'pending'",
      job.id);
  record_end(tx, job, v1::JOB_STATE_DONE, "");
  return true;
}

/// Moves a job on through its stages.  True when it is done.
bool go_through_stages(Tx& tx, JobRow& job) {
  // That may write the whole field, for which a full disk has no room: see settle_waiting_jobs().
  if (job.stage == v1::JOB_STAGE_ERODE && tx.room && !has_blocks_left(tx.db, job)) finish_erosion(tx, job);
  if (job.stage == v1::JOB_STAGE_REFINE && tx.room && !has_blocks_left(tx.db, job)) go_on_refining(tx, job);
  return job.stage == v1::JOB_STAGE_DERIVE && finish_derive(tx, job);
}

/// The same; a job of which stored rows turn out to be damaged has come to its end, too: it has failed, for who settles
/// it is often about others.  What was merged so far stays, for it is true.
bool go_on_or_fail(Tx& tx, JobRow& job) {
  v1::JobError error;
  error.set_code(kDamagedCode);
  try {
    return go_through_stages(tx, job);
  } catch (const StoreError& damaged) {
    if (damaged.code() != StoreError::Code::kDamaged) throw;
    error.set_message(damaged.what());
  }
  fail_job(tx, job.id, error);
  return true;
}

}  // namespace

std::string progress_text(const JobRow& job) {
  if (job.directions == 0) return {};
  return std::to_string(job.directions_done) + " of " + base::counted(job.directions, "direction");
}

void fail_job(Tx& tx, const std::string& job_id, const v1::JobError& error) {
  const JobRow job = get_job(tx.db, job_id);
  if (!job.active()) return;
  tx.db.run(
      "UPDATE jobs SET state = 'failed', finished_ms = ?, cancel_requested = 0, error_code = ?,"
      " error_message = ?, error_line = ? WHERE id = ?",
      tx.wall_ms, error.code(), error.message(), error.line(), job_id);
  tx.changes.jobs.insert(job_id);
  record_end(tx, job, v1::JOB_STATE_FAILED, error.code() + ": " + error.message());
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
  if (go_on_or_fail(tx, job)) return;
  if (!job.cancel_requested) return;
  if (tx.db.integer("SELECT 1 FROM tasks WHERE job_id = ? AND state = 'leased' AND on_request = 0 LIMIT 1",
                    job_id)) {
    return;
  }
  tx.db.run("UPDATE jobs SET state = 'cancelled', cancel_requested = 0, finished_ms = ? WHERE id = ?",
            tx.wall_ms, job_id);
  record_end(tx, job, v1::JOB_STATE_CANCELLED, progress_text(job));
}

void finish_whole_blocks(Tx& tx, const std::string& job_id) {
  tx.db.run(
      "UPDATE tasks SET state = 'done' WHERE job_id = ? AND kind = 'erode' AND state = 'pending' AND EXISTS"
      " (SELECT 1 FROM done_ranges r JOIN jobs j ON j.erosion_id = r.erosion_id WHERE j.id = tasks.job_id"
      "  AND r.first_position <= tasks.first_position AND r.end_position >= tasks.end_position)",
      job_id);
}

void settle_waiting_jobs(Tx& tx) {
  std::vector<std::string> jobs;
  {
    Statement row = tx.db.query(
        "SELECT id FROM jobs j WHERE state IN ('queued', 'running') AND (stage IN ('erode', 'refine')"
        " AND NOT EXISTS (SELECT 1 FROM tasks WHERE job_id = j.id AND kind = j.stage AND state <> 'done')"
        " OR cancel_requested = 1 AND NOT EXISTS"
        " (SELECT 1 FROM tasks WHERE job_id = j.id AND state = 'leased' AND on_request = 0))");
    while (row.step()) jobs.push_back(row.text(0));
  }
  for (const std::string& job : jobs) settle_job(tx, job);
}

}  // namespace affskel::server

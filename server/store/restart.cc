#include "store/restart.h"

#include <string>
#include <vector>

#include "store/blocks.h"
#include "store/job_life.h"
#include "store/refinement.h"
#include "store/rows.h"
#include "store/task_rows.h"

namespace affskel::server {
namespace {

bool core_is_current(Database& db, std::int64_t erosion_id) {
  const std::string current = current_core_version(db);
  Statement row = db.query("SELECT core_version FROM erosions WHERE id = ?", erosion_id);
  return current.empty() || (row.step() && row.text(0) == current);
}

std::vector<std::string> jobs_of(Database& db, std::int64_t erosion_id) {
  Statement row = db.query(
      "SELECT id FROM jobs WHERE erosion_id = ? ORDER BY state IN ('queued', 'running') AND NOT"
      " cancel_requested DESC, state = 'done' DESC, seq",
      erosion_id);
  std::vector<std::string> jobs;
  while (row.step()) jobs.push_back(row.text(0));
  return jobs;
}

void give_own_erosion(Tx& tx, const std::string& job, std::int64_t like) {
  tx.db.run(
      "INSERT INTO erosions (mesh_sha256, params, params_key)"
      " SELECT mesh_sha256, params, params_key FROM erosions WHERE id = ?",
      like);
  tx.db.run("UPDATE jobs SET erosion_id = ? WHERE id = ?", tx.db.last_insert_rowid(), job);
  queue_again(tx, job, "prepare");
  add_task(tx, job, v1::TASK_KIND_PREPARE);
}

/// The job computes what is missing.
void go_on_with(Tx& tx, const std::string& job_id, std::int64_t directions) {
  const JobRow job = get_job(tx.db, job_id);
  if (job.refines && job.directions_done == directions) {
    queue_again(tx, job_id, "refine");
    return begin_refinement(tx, job);
  }
  queue_again(tx, job_id, "erode");
  cut_blocks(tx, job_id, directions);
  finish_whole_blocks(tx, job_id);
}

}  // namespace

void restart_erosion(Tx& tx, std::int64_t erosion_id, std::int64_t directions) {
  tx.db.run(
      "UPDATE erosions SET finished = 0, revision = revision + 1, directions_done ="
      " (SELECT ifnull(sum(end_position - first_position), 0) FROM done_ranges WHERE erosion_id = ?1)"
      " WHERE id = ?1",
      erosion_id);
  forget_refinement(tx, erosion_id);
  tx.db.run("DELETE FROM artifacts WHERE erosion_id = ? AND kind NOT IN ('lattice', 'directions')",
            erosion_id);
  bool taken = !core_is_current(tx.db, erosion_id);
  const std::vector<std::string> jobs = jobs_of(tx.db, erosion_id);
  for (const std::string& job : jobs) {
    tx.db.run("DELETE FROM tasks WHERE job_id = ?", job);
    if (taken) {
      give_own_erosion(tx, job, erosion_id);
    } else {
      go_on_with(tx, job, directions);
      taken = true;
    }
    tx.changes.jobs.insert(job);
  }
  if (!tx.db.integer("SELECT 1 FROM jobs WHERE erosion_id = ? LIMIT 1", erosion_id)) {
    tx.db.run("UPDATE erosions SET dropped = 1 WHERE id = ?", erosion_id);
  }
  // What was to be cancelled once its workers knew waits for none any more.
  for (const std::string& job : jobs) settle_job(tx, job);
}

void queue_again(Tx& tx, const std::string& job, const char* stage) {
  tx.db.run(
      "UPDATE jobs SET stage = ?1, stage_ms = ?2, queued_ms = ?2, skeleton_points = 0, quality = NULL,"
      " (state, finished_ms, error_code, error_message) ="
      " (SELECT iif(again, 'queued', state), iif(again, 0, finished_ms), iif(again, NULL, error_code),"
      "  iif(again, '', error_message)"
      "  FROM (SELECT state = 'done' OR ifnull(error_code, '') = 'DAMAGED' AS again))"
      " WHERE id = ?3",
      stage, tx.wall_ms, job);
}

}  // namespace affskel::server

#include <vector>

#include "base/number_text.h"
#include "database/errors.h"
#include "store/distrust.h"
#include "store/givers.h"
#include "store/job_events.h"
#include "store/job_life.h"
#include "store/memory_need.h"
#include "store/quota.h"
#include "store/retention.h"
#include "store/store_impl.h"
#include "store/task_rows.h"
#include "store/verification.h"
#include "wire/words.h"

namespace affskel::server {

v1::Job Store::job(const JobRef& job_ref) {
  v1::Job job = read([&](Database& db) { return job_message(db, resolve_job(db, job_ref)); });
  times_left_.fill_in(job, clock_.lease_ms());
  return job;
}

std::string Store::resolve(const JobRef& job_ref) {
  return read([&](Database& db) { return resolve_job(db, job_ref); });
}

JobPage Store::list(const ListFilter& filter) {
  JobPage page = read([&](Database& db) { return list_jobs(db, filter); });
  for (v1::Job& job : page.jobs) times_left_.fill_in(job, clock_.lease_ms());
  return page;
}

v1::ListJobEventsResponse Store::events(const JobRef& job_ref, std::int64_t after) {
  return read([&](Database& db) {
    const JobRow job = get_job(db, resolve_job(db, job_ref));
    v1::ListJobEventsResponse events = job_events(db, job.id, after);
    for (v1::Giver& giver : givers_of(db, job)) *events.add_givers() = std::move(giver);
    return events;
  });
}

Store::Counts Store::counts() {
  return read([](Database& db) {
    const auto count = [&](const char* sql) { return db.integer(sql).value_or(0); };
    return Counts{
        count("SELECT count(*) FROM jobs WHERE state = 'queued'"),
        count("SELECT count(*) FROM jobs WHERE state = 'running'"),
        count("SELECT count(*) FROM jobs"),
        // A sample may wait for another worker for long: no client is kept by it.
        count("SELECT count(*) FROM tasks WHERE on_request = 1 AND state IN ('pending', 'leased')"
              " AND (kind <> 'verify' OR state = 'leased')"),
    };
  });
}

Store::Counts Store::counts_of(const std::string& owner) {
  return read([&owner](Database& db) {
    Statement row = db.query(
        "SELECT total(state = 'queued'), total(state = 'running'), count(*),"
        " (SELECT count(*) FROM tasks t JOIN jobs j ON j.id = t.job_id WHERE j.owner = ?1"
        "   AND t.on_request = 1 AND t.state IN ('pending', 'leased')) FROM jobs WHERE owner = ?1",
        owner);
    row.step();
    return Counts{static_cast<std::int64_t>(row.real(0)), static_cast<std::int64_t>(row.real(1)),
                  row.integer(2), row.integer(3)};
  });
}

v1::Job Store::write_job(const JobRef& job_ref, const std::function<void(Tx&, const JobRow&)>& change) {
  return write([&](Tx& tx) {
    const std::string id = resolve_job(tx.db, job_ref);
    change(tx, get_job(tx.db, id));
    return job_message(tx.db, id);
  });
}

v1::Job Store::cancel(const JobRef& job_ref) {
  return write_job(job_ref, [](Tx& tx, const JobRow& job) {
    const std::int64_t requests = tx.db.run(
        "DELETE FROM tasks WHERE job_id = ? AND on_request = 1 AND state IN ('pending', 'leased')", job.id);
    if (requests > 0) {
      cancel_samples(tx, job.id);
      tx.changes.jobs.insert(job.id);
      add_event(
          tx, job.id,
          {.event = "requests_cancelled", .message = base::counted(requests, "request") + " for artefacts"});
    }
    if (!job.active()) {
      if (requests > 0 || job.state == v1::JOB_STATE_CANCELLED) return;
      throw StoreError(StoreError::Code::kPrecondition,
                       "job " + job.id + " is " + wire::word(job.state) + ": nothing to cancel");
    }
    tx.db.run("UPDATE jobs SET cancel_requested = 1 WHERE id = ?", job.id);
    tx.changes.eased = true;
    add_event(tx, job.id, {.event = "cancel_requested"});
    settle_job(tx, job.id);
  });
}

namespace {

/// A done job whose results were removed: by its own work, or another job's that is done.
void compute_again(Tx& tx, const JobRow& job) {
  require_queue_room(tx.db, tx.options.policy, job.owner);
  tx.require_room();
  begin_erosion_anew(tx, job);
  tx.db.run(
      "UPDATE jobs SET state = 'queued', stage = 'prepare', finished_ms = 0, queued_ms = ?,"
      " skeleton_points = 0,"
      " quality = NULL, removed_ms = 0, expires_ms = 0 WHERE id = ?",
      tx.wall_ms, job.id);
  tx.changes.jobs.insert(job.id);
  add_event(tx, job.id, {.event = "resumed", .message = "its results were removed"});
  const std::optional<std::int64_t> finished =
      find_finished_erosion(tx.db, job.owner, job.mesh_sha256, job.params_key, current_core_version(tx.db));
  if (finished) return adopt_erosion(tx, job.id, *finished);
  add_task(tx, job.id, v1::TASK_KIND_PREPARE);
}

/// What workers found may have been true of them that day only.
void forget_memory_needs(Tx& tx, const std::string& job) {
  std::vector<std::int64_t> pending;
  {
    Statement row = tx.db.query("SELECT id FROM tasks WHERE job_id = ? AND state = 'pending'", job);
    while (row.step()) pending.push_back(row.integer(0));
  }
  for (const std::int64_t id : pending) {
    const TaskRow task = *find_task(tx.db, id);
    tx.db.run("UPDATE tasks SET needs_memory = ?2 WHERE id = ?1 AND needs_memory <> ?2", id,
              memory_need_of(tx.db, job, task.kind, task.params));
  }
}

void go_on(Tx& tx, const JobRow& job, bool by_administrator = false) {
  if (job.state == v1::JOB_STATE_DONE && job.removed_ms > 0) return compute_again(tx, job);
  if (job.state == v1::JOB_STATE_DONE) {
    throw StoreError(StoreError::Code::kPrecondition, "job " + job.id + " is done: nothing to resume");
  }
  if (job.active() && !job.cancel_requested) return;
  if (!job.active() && !by_administrator) require_queue_room(tx.db, tx.options.policy, job.owner);
  tx.db.run(
      "UPDATE jobs SET state = iif(cancel_requested, state, 'queued'), cancel_requested = 0,"
      " finished_ms = 0, queued_ms = iif(cancel_requested, queued_ms, ?1), stage_ms = iif(cancel_requested, stage_ms, ?1),"
      " error_code = NULL, error_message = '', error_line = 0, removed_ms = 0, expires_ms = 0 WHERE id = ?2",
      tx.wall_ms, job.id);
  tx.db.run("UPDATE tasks SET losses = 0 WHERE job_id = ?", job.id);
  forget_memory_needs(tx, job.id);
  tx.changes.work = true;
  add_event(tx, job.id, {.event = "resumed"});
  settle_job(tx, job.id);
}

}  // namespace

v1::Job Store::resume(const JobRef& job_ref) {
  return write_job(job_ref, [](Tx& tx, const JobRow& job) { go_on(tx, job); });
}

v1::Job Store::resume_without(const JobRef& job_ref, const std::string& worker) {
  return write_job(job_ref, [&worker](Tx& tx, const JobRow& job) {
    distrust(tx, job, worker);
    // What a liar gave is taken out however many jobs their owner has queued.
    go_on(tx, get_job(tx.db, job.id), true);
  });
}

std::set<std::string> Store::distrusted() {
  return read([](Database& db) { return affskel::server::distrusted(db); });
}

std::string Store::remove(const JobRef& job_ref) {
  return write([&](Tx& tx) {
    const JobRow job = get_job(tx.db, resolve_job(tx.db, job_ref));
    if (job.active()) {
      throw StoreError(StoreError::Code::kPrecondition,
                       "job " + job.id + " is " + wire::word(job.state) +
                           (job.cancel_requested ? ", and will be cancelled within seconds: delete it then"
                                                 : ": cancel it first"));
    }
    add_event(tx, job.id, {.event = "deleted"});  // for the log: the job takes its events along
    delete_job(tx, job);
    return job.id;
  });
}

}  // namespace affskel::server

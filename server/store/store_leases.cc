#include <algorithm>

#include "errors.h"
#include "store/store_impl.h"
#include "store/tasks.h"
#include "wire/identity.h"
#include "wire/version.h"

namespace affskel::server {

void check_worker(const v1::WorkerIdentity& worker) {
  const auto refuse = [](const char* why) { throw StoreError(StoreError::Code::kInvalid, why); };
  if (worker.id().empty() || worker.id().size() > kMaxWorkerIdBytes)
    refuse("a worker needs an id of 1 .. 64 bytes");
  if (worker.threads() < 1) refuse("a worker has at least one thread");
  if (worker.core_version().empty()) refuse("a worker must tell the version of its core");
  if (worker.host().size() > 255 || worker.core_version().size() > 64)
    refuse("a worker's host or version is too long");
}

namespace {

void remember_core_version(Tx& tx, const std::string& version) {
  if (current_core_version(tx.db) == version) return;
  tx.db.run(
      "INSERT INTO server_state (key, value) VALUES ('core_version/' || ?, ?)"
      " ON CONFLICT (key) DO UPDATE SET value = excluded.value",
      wire::kVersion, version);
}

/// The next task for this worker.  Somebody waits for an artefact on request, and it takes seconds: those
/// first; then by priority, then the job whose mesh the worker holds already, then age.  Fields of
/// different core versions are never mixed.
std::optional<std::int64_t> choose_task(Database& db, const v1::WorkerIdentity& worker,
                                        const std::string& preferred) {
  return db.integer(
      "SELECT t.id FROM tasks t JOIN jobs j ON j.id = t.job_id JOIN erosions e ON e.id = j.erosion_id"
      " WHERE t.state = 'pending'"
      " AND (t.on_request = 1 OR (j.state IN ('queued', 'running') AND j.cancel_requested = 0))"
      " AND (t.kind <> 'erode' OR e.core_version = ?)"
      " ORDER BY t.on_request DESC, j.priority DESC, j.id = ? DESC, j.seq, t.id LIMIT 1",
      worker.core_version(), preferred);
}

/// Takes the finished field of another job instead of preparing, if there is one by now.
bool adopt_instead(Tx& tx, const TaskRow& task, const std::string& core_version) {
  if (task.kind != v1::TASK_KIND_PREPARE) return false;
  const JobRow job = get_job(tx.db, task.job_id);
  const std::optional<std::int64_t> finished =
      find_finished_erosion(tx.db, job.mesh_sha256, job.params_key, core_version);
  if (!finished) return false;
  adopt_erosion(tx, job.id, *finished);
  return true;
}

void grant(Tx& tx, const TaskRow& task, const v1::WorkerIdentity& worker, bool supervised,
           const std::string& token) {
  tx.db.run(
      "UPDATE tasks SET state = 'leased', token = ?, worker = ?, host = ?, pid = ?, supervised = ?,"
      " core_version = ?, granted_ms = ?, reported_ms = NULL, deadline_ms = ?, lease_directions = 0"
      " WHERE id = ?",
      token, worker.id(), worker.host(), worker.pid(), supervised, worker.core_version(), tx.lease_ms,
      tx.lease_ms + tx.options.lease_ms, task.id);
  tx.db.run(
      "UPDATE jobs SET leases_granted = leases_granted + 1, started_ms = iif(started_ms = 0, ?, started_ms),"
      " state = iif(state = 'queued', 'running', state) WHERE id = ?",
      tx.wall_ms, task.job_id);
  tx.changes.jobs.insert(task.job_id);
  tx.changes.log.push_back("event=leased job=" + task.job_id + " task=" + std::to_string(task.id) + " kind=" +
                           kind_name(task.kind) + " worker=" + worker.id() + " lease=" + token.substr(0, 8));
}

v1::Lease lease_message(Tx& tx, const TaskRow& task, const std::string& token) {
  v1::Lease lease;
  lease.set_token(token);
  lease.set_kind(task.kind);
  *lease.mutable_job() = job_message(tx.db, task.job_id);
  lease.set_lease_ms(static_cast<std::uint32_t>(tx.options.lease_ms));
  lease.set_report_interval_ms(static_cast<std::uint32_t>(tx.options.report_interval_ms));
  if (task.kind == v1::TASK_KIND_ERODE) {
    const JobRow job = get_job(tx.db, task.job_id);
    for (const Range& range : remaining_ranges(tx.db, job.erosion_id, task.block)) {
      v1::PositionRange* positions = lease.add_positions();
      positions->set_begin(static_cast<std::uint64_t>(range.begin));
      positions->set_end(static_cast<std::uint64_t>(range.end));
    }
  }
  switch (task.kind) {
    case v1::TASK_KIND_SKELETON:
    case v1::TASK_KIND_DIVERGENCE:
      lease.mutable_skeleton()->ParseFromString(task.params);
      break;
    case v1::TASK_KIND_SURFACE:
      lease.mutable_surface()->ParseFromString(task.params);
      break;
    case v1::TASK_KIND_ERODED_POINTS:
    case v1::TASK_KIND_ERODED_SURFACE:
      lease.mutable_eroded()->ParseFromString(task.params);
      break;
    default:
      break;
  }
  return lease;
}

/// Loses the leases that a query names by task id.
int lose_all(Tx& tx, Statement&& ids, const std::string& why) {
  std::vector<std::int64_t> lost;
  while (ids.step()) lost.push_back(ids.integer(0));
  for (std::int64_t id : lost) {
    // An earlier loss of this round may have failed the whole job; the lease is lost all the same.
    if (const std::optional<TaskRow> task = find_task(tx.db, id); task && task->state == "leased") {
      lose_lease(tx, *task, why);
    }
  }
  return static_cast<int>(lost.size());
}

int expire(Tx& tx) {
  return lose_all(tx,
                  tx.db.query("SELECT id FROM tasks WHERE state = 'leased' AND deadline_ms < ?", tx.lease_ms),
                  "silent for longer than its lease");
}

}  // namespace

std::optional<v1::Lease> Store::lease(const v1::WorkerIdentity& worker, const std::string& preferred_job,
                                      bool supervised) {
  check_worker(worker);
  return write([&](Tx& tx) -> std::optional<v1::Lease> {
    expire(tx);
    if (!tx.room) return std::nullopt;  // what would come of it could not be stored
    remember_core_version(tx, worker.core_version());
    while (const std::optional<std::int64_t> id = choose_task(tx.db, worker, preferred_job)) {
      const TaskRow task = *find_task(tx.db, *id);
      if (adopt_instead(tx, task, worker.core_version())) continue;
      const std::string token = wire::random_id();
      grant(tx, task, worker, supervised, token);
      return lease_message(tx, task, token);
    }
    return std::nullopt;
  });
}

v1::ReportResponse Store::renew(const std::string& token) {
  return write([&](Tx& tx) {
    const TaskRow task = task_of_token(tx.db, token);
    if (task.state == "done") return reply(false);
    const JobRow job = get_job(tx.db, task.job_id);
    if (!task.on_request && (!job.active() || job.cancel_requested)) {
      release_task(tx, task);
      settle_job(tx, task.job_id);
      return reply(true);
    }
    renew_lease(tx, task);
    return reply(false);
  });
}

v1::ReportResponse Store::give_back(const std::string& token) {
  return write([&](Tx& tx) {
    const TaskRow task = task_of_token(tx.db, token);
    if (task.state == "done") return reply(false);
    release_task(tx, task);
    tx.changes.log.push_back("event=returned job=" + task.job_id + " task=" + std::to_string(task.id) +
                             " worker=" + task.worker);
    settle_job(tx, task.job_id);
    return reply(false);
  });
}

int Store::expire_leases() {
  return write([](Tx& tx) { return expire(tx); });
}

int Store::release_worker(const std::string& host, std::int64_t pid) {
  return write([&](Tx& tx) {
    return lose_all(
        tx, tx.db.query("SELECT id FROM tasks WHERE state = 'leased' AND host = ? AND pid = ?", host, pid),
        "its process ended");
  });
}

std::vector<Store::Holder> Store::supervised_holders() {
  return read([](Database& db) {
    Statement row =
        db.query("SELECT DISTINCT host, pid FROM tasks WHERE state = 'leased' AND supervised = 1");
    std::vector<Holder> holders;
    while (row.step()) holders.push_back({row.text(0), row.integer(1)});
    return holders;
  });
}

}  // namespace affskel::server

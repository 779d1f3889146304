#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

#include "database/errors.h"
#include "store/distrust.h"
#include "store/job_events.h"
#include "store/job_life.h"
#include "store/store_impl.h"
#include "store/task_leases.h"
#include "store/task_rows.h"
#include "store/turn.h"
#include "store/verification.h"
#include "wire/artifact_kinds.h"
#include "wire/identity.h"
#include "wire/version.h"
#include "wire/words.h"

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

constexpr std::size_t kMaxHeldTokens = 16;

void remember_core_version(Tx& tx, const std::string& version) {
  if (current_core_version(tx.db) == version) return;
  tx.db.run(
      "INSERT INTO server_state (key, value) VALUES ('core_version/' || ?, ?)"
      " ON CONFLICT (key) DO UPDATE SET value = excluded.value",
      wire::kVersion, version);
}

Seeker seeker_of(const v1::WorkerIdentity& worker, const std::string& preferred_job) {
  Seeker seeker;
  seeker.worker = worker.id();
  seeker.core_version = worker.core_version();
  seeker.preferred_job = preferred_job;
  // Workers that do not say are offered everything.
  if (worker.memory() > 0) {
    seeker.memory = static_cast<std::int64_t>(
        std::min(worker.memory(), static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max())));
  }
  return seeker;
}

struct Leased {
  std::int64_t requests = 0;
  std::int64_t others = 0;
};

Leased count_leased(Database& db) {
  Statement row = db.query("SELECT count(*), total(on_request) FROM tasks WHERE state = 'leased'");
  row.step();
  const auto requests = static_cast<std::int64_t>(row.real(1));
  return {requests, row.integer(0) - requests};
}

/// Takes the finished field of another job instead of preparing, if there is one by now.
bool adopt_instead(Tx& tx, const TaskRow& task, const std::string& core_version) {
  if (task.kind != v1::TASK_KIND_PREPARE || task.on_request) return false;
  const JobRow job = get_job(tx.db, task.job_id);
  const std::optional<std::int64_t> finished =
      find_finished_erosion(tx.db, job.owner, job.mesh_sha256, job.params_key, core_version);
  if (!finished) return false;
  adopt_erosion(tx, job.id, *finished);
  return true;
}

bool has_block(const TaskRow& task) {
  return task.kind == v1::TASK_KIND_ERODE || task.kind == v1::TASK_KIND_REFINE;
}

void grant(Tx& tx, const TaskRow& task, const v1::WorkerIdentity& worker, bool supervised,
           const std::string& token) {
  tx.db.run(
      "UPDATE tasks SET state = 'leased', token = ?, late_token = NULL, worker = ?, host = ?, pid = ?,"
      " supervised = ?, core_version = ?, granted_ms = ?, reported_ms = NULL, deadline_ms = ?,"
      " stalled_ms = ?, waited_ms = NULL, lease_directions = 0 WHERE id = ?",
      token, worker.id(), worker.host(), worker.pid(), supervised, worker.core_version(), tx.lease_ms,
      tx.lease_ms + tx.options.lease_ms, tx.lease_ms + patience_ms(tx, task), task.id);
  end_turn(tx, task);
  tx.db.run(
      "UPDATE jobs SET leases_granted = leases_granted + 1, started_ms = iif(started_ms = 0, ?1, started_ms),"
      " stage_ms = iif(stage = 'prepare' AND state = 'queued', ?1, stage_ms),"
      " state = iif(state = 'queued', 'running', state) WHERE id = ?2",
      tx.wall_ms, task.job_id);
  tx.changes.jobs.insert(task.job_id);
  std::string message = "lease " + token.substr(0, 8);
  if (has_block(task)) {
    message += (task.kind == v1::TASK_KIND_ERODE ? ", positions "
                                                 : ", round " + std::to_string(task.round) + ", points ") +
               std::to_string(task.block.begin) + " .. " + std::to_string(task.block.end - 1);
  }
  add_event(tx, task.job_id, {"leased", task.id, task.kind, worker.id(), std::move(message)});
  tx.changes.counts.push_back(
      [kind = wire::word(task.kind)](Metrics& metrics) { metrics.lease_granted(kind); });
}

v1::Lease lease_message(Tx& tx, const TaskRow& task, const std::string& token) {
  v1::Lease lease;
  lease.set_token(token);
  lease.set_kind(task.kind);
  *lease.mutable_job() = job_message(tx.db, task.job_id);
  const JobRow job = get_job(tx.db, task.job_id);
  lease.set_field(field_name(tx.db, job.erosion_id));
  lease.set_lease_ms(static_cast<std::uint32_t>(tx.options.lease_ms));
  lease.set_report_interval_ms(static_cast<std::uint32_t>(tx.options.report_interval_ms));
  lease.set_round(static_cast<std::uint32_t>(task.round));
  if (has_block(task)) {
    for (const Range& range : left_of_block(tx.db, job, task)) {
      v1::PositionRange* positions = lease.add_positions();
      positions->set_begin(static_cast<std::uint64_t>(range.begin));
      positions->set_end(static_cast<std::uint64_t>(range.end));
    }
  }
  if (task.kind == v1::TASK_KIND_VERIFY) lease.MergeFromString(task.params);
  if (const wire::ArtifactKindInfo* kind = wire::find_derived_kind(task.kind)) {
    wire::set_task_params(kind->params, task.params, lease);
  }
  return lease;
}

/// Loses the leases that a query names by task id.
int lose_all(Tx& tx, Statement&& ids, const std::string& why, bool may_come_back = false) {
  std::vector<std::int64_t> lost;
  while (ids.step()) lost.push_back(ids.integer(0));
  for (std::int64_t id : lost) {
    // An earlier loss of this round may have failed the whole job; the lease is lost all the same.
    if (const std::optional<TaskRow> task = find_task(tx.db, id); task && task->state == "leased") {
      lose_lease(tx, *task, why, may_come_back);
    }
  }
  return static_cast<int>(lost.size());
}

int expire(Tx& tx) {
  const int silent = lose_all(
      tx, tx.db.query("SELECT id FROM tasks WHERE state = 'leased' AND deadline_ms < ?", tx.lease_ms),
      "silent for longer than its lease", true);
  return silent +
         lose_all(tx,
                  tx.db.query("SELECT id FROM tasks WHERE state = 'leased' AND stalled_ms < ?", tx.lease_ms),
                  "no progress for longer than its job gives reason for");
}

/// Renews a lease of a worker that asks for more, or takes an input.  That it has ended, or its job was cancelled, the
/// worker hears when it speaks of that lease.
void renew_held(Tx& tx, const std::string& token) {
  std::optional<TaskRow> task = find_task_of_token(tx.db, token);
  if (!task || task->state == "done" || is_cancelled(*task, get_job(tx.db, task->job_id))) return;
  renew_lease(tx, resume_if_late(tx, *std::move(task)));
}

void check_asking(const Store::LeaseAsk& ask) {
  check_worker(ask.worker);
  if (ask.held.size() <= kMaxHeldTokens) return;
  throw StoreError(StoreError::Code::kInvalid,
                   "a worker that asks for work names at most " + std::to_string(kMaxHeldTokens) +
                       " leases that it holds, not " + std::to_string(ask.held.size()));
}

/// Not about the database, or a change that was begun.
bool is_about_caller(const StoreError& error) {
  return error.code() == StoreError::Code::kInvalid || error.code() == StoreError::Code::kForbidden;
}

/// Requests for artefacts that no call waits for any more, or whose failure none asks for.
void drop_old_requests(Tx& tx, const std::set<std::int64_t>& orphans) {
  for (const std::int64_t id : orphans) {
    const std::optional<TaskRow> task = find_task(tx.db, id);
    if (!task || !task->on_request || task->kind == v1::TASK_KIND_VERIFY || task->state == "failed") continue;
    tx.db.run("DELETE FROM tasks WHERE id = ?", id);
    add_event(tx, task->job_id,
              task_event("request_withdrawn", *task, "nobody has asked again since the restart"));
  }
  tx.db.run("DELETE FROM tasks WHERE state = 'failed' AND on_request = 1 AND deadline_ms < ?", tx.lease_ms);
}

}  // namespace

/// Requests for artefacts have at most every second grant, and half of what is leased, as long as jobs wait.
bool Store::requests_turn(std::int64_t leased_requests, std::int64_t leased_blocks) const {
  return !last_was_request_ && leased_requests <= leased_blocks;
}

std::optional<std::int64_t> Store::choose_task(Database& db, const Seeker& seeker) {
  // A sample is a request that not every worker may take: the older of the two comes first.
  std::optional<std::int64_t> request = task_in_turn(db, seeker, true, options_.owner_order);
  const std::optional<std::int64_t> sample = sample_for(db, seeker);
  if (sample && (!request || *sample < *request)) request = sample;
  const std::optional<std::int64_t> next = task_in_turn(db, seeker, false, options_.owner_order);
  if (!next || !request) return next ? next : request;
  const Leased leased = count_leased(db);
  last_was_request_ = requests_turn(leased.requests, leased.others);
  return last_was_request_ ? request : next;
}

std::optional<v1::Lease> Store::grant_next(Tx& tx, const LeaseAsk& ask) {
  check_asking(ask);
  for (const std::string& token : ask.held) renew_held(tx, token);
  require_trusted(tx.db, ask.worker);
  if (!tx.room) return std::nullopt;  // what would come of it could not be stored
  remember_core_version(tx, ask.worker.core_version());
  const std::int64_t held =
      tx.db.integer("SELECT count(*) FROM tasks WHERE state = 'leased' AND worker = ?", ask.worker.id())
          .value_or(0);
  if (held >= tx.options.max_leases_held) return std::nullopt;
  const Seeker seeker = seeker_of(ask.worker, ask.preferred_job);
  while (const std::optional<std::int64_t> id = choose_task(tx.db, seeker)) {
    const TaskRow task = *find_task(tx.db, *id);
    if (adopt_instead(tx, task, ask.worker.core_version())) continue;
    const std::string token = wire::random_id();
    grant(tx, task, ask.worker, ask.supervised, token);
    v1::Lease lease = lease_message(tx, task, token);
    if (lease.job().error().code() != kDamagedCode) return lease;
    give_up(tx, task, lease.job().error());  // its turn would come again and again
  }
  return std::nullopt;
}

std::vector<Store::LeaseAnswer> Store::lease_all(const std::vector<LeaseAsk>& asks) {
  return write([&](Tx& tx) {
    mutex_.assert_held();
    expire(tx);
    std::vector<LeaseAnswer> answers;
    for (const LeaseAsk& ask : asks) {
      LeaseAnswer& answer = answers.emplace_back();
      try {
        answer.lease = grant_next(tx, ask);
      } catch (const StoreError& error) {
        // Others get theirs; what a refusal leaves is what it has renewed.
        if (!is_about_caller(error)) throw;
        answer.refused = std::current_exception();
      }
    }
    return answers;
  });
}

std::optional<v1::Lease> Store::lease(const v1::WorkerIdentity& worker, const std::string& preferred_job,
                                      bool supervised, const std::vector<std::string>& held) {
  LeaseAnswer answer = std::move(lease_all({{worker, preferred_job, supervised, held}}).front());
  if (answer.refused) std::rethrow_exception(answer.refused);
  return std::move(answer.lease);
}

v1::ReportResponse Store::renew(const std::string& token) {
  return write([&](Tx& tx) {
    const TaskRow task = held_task(tx, token);
    if (task.state == "done") return reply(false);
    if (is_cancelled(task, get_job(tx.db, task.job_id))) {
      release_task(tx, task);
      settle_job(tx, task.job_id);
      return reply(true);
    }
    renew_lease(tx, task);
    return reply(false);
  });
}

void Store::keep_lease(const std::string& token) {
  write([&](Tx& tx) {
    renew_held(tx, token);
    return true;
  });
}

v1::ReportResponse Store::give_back(const std::string& token) {
  return write([&](Tx& tx) {
    const TaskRow task = held_task(tx, token);
    if (task.state == "done") return reply(false);
    release_task(tx, task);
    add_event(tx, task.job_id, task_event("returned", task));
    settle_job(tx, task.job_id);
    return reply(false);
  });
}

int Store::expire_leases() {
  std::set<std::int64_t> withdrawn;
  const int lost = write([&](Tx& tx) {
    mutex_.assert_held();
    withdrawn = tx.lease_ms >= orphans_until_ms_ ? orphans_ : std::set<std::int64_t>();
    drop_old_requests(tx, withdrawn);
    return expire(tx);
  });
  const base::MutexLock lock(mutex_);
  for (const std::int64_t id : withdrawn) orphans_.erase(id);
  return lost;
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

std::set<std::string> Store::requested_jobs() {
  // Asked for whenever workers wait, and only to tell who of them comes first: of requests for more jobs than these,
  // whoever comes finds one.
  return read([](Database& db) {
    constexpr std::int64_t kMostJobs = 16;
    Statement row = db.query(
        "SELECT DISTINCT job_id FROM tasks WHERE state = 'pending' AND parked = 0 AND on_request = 1 LIMIT ?",
        kMostJobs);
    std::set<std::string> jobs;
    while (row.step()) jobs.insert(row.text(0));
    return jobs;
  });
}

}  // namespace affskel::server

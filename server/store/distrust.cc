#include "store/distrust.h"

#include <vector>

#include "base/number_text.h"
#include "base/quoted.h"
#include "database/errors.h"
#include "store/field.h"
#include "store/givers.h"
#include "store/job_events.h"
#include "store/job_life.h"
#include "store/restart.h"
#include "store/task_leases.h"
#include "store/task_rows.h"

namespace affskel::server {
namespace {

constexpr std::size_t kShortestPrefix = 6;

/// @param is_host becomes true where `who` is one.
std::vector<Giver> named(Database& db, const JobRow& job, const std::string& who, bool& is_host) {
  std::vector<Giver> of_host, of_prefix;
  for (const v1::Giver& giver : givers_of(db, job)) {
    if (giver.worker() == who) return {Giver{giver.worker(), giver.host()}};
    if (giver.host() == who) of_host.push_back({giver.worker(), giver.host()});
    if (who.size() >= kShortestPrefix && giver.worker().starts_with(who)) {
      of_prefix.push_back({giver.worker(), giver.host()});
    }
  }
  is_host = !of_host.empty();
  if (is_host) return of_host;
  if (of_prefix.size() > 1) {
    throw StoreError(StoreError::Code::kInvalid,
                     "worker " + base::quoted(who) + ": more than one worker's id begins so");
  }
  if (of_prefix.empty()) {
    throw StoreError(StoreError::Code::kNotFound, "no worker " + base::quoted(who) +
                                                      " has told anything about the field of job " + job.id +
                                                      "; affskel-client log names those that have");
  }
  return of_prefix;
}

/// The done ranges without those that were given.
void undo(Database& db, std::int64_t erosion_id, const std::vector<Range>& given) {
  std::vector<Range> kept;
  for (Range done : done_ranges(db, erosion_id)) {
    for (const Range& gone : given) {
      if (gone.end <= done.begin || gone.begin >= done.end) continue;
      if (gone.begin > done.begin) kept.push_back({done.begin, gone.begin});
      done.begin = gone.end;
      if (done.begin >= done.end) break;
    }
    if (done.begin < done.end) kept.push_back(done);
  }
  db.run("DELETE FROM done_ranges WHERE erosion_id = ?", erosion_id);
  for (const Range& range : kept) add_done_range(db, erosion_id, range);
}

/// Its leases on other jobs end, too; the tasks go to others.
/// @param giver a host's has the host's name for its worker's: it stands for all workers there, with whatever ids.
void bar(Tx& tx, const Giver& giver) {
  tx.db.run(
      "INSERT INTO distrusted (worker, host, since_ms) VALUES (?, ?, ?) ON CONFLICT (worker) DO NOTHING",
      giver.worker, giver.host, tx.wall_ms);
  std::vector<std::int64_t> held;
  {
    Statement row =
        tx.db.query("SELECT id FROM tasks WHERE state = 'leased' AND ? IN (worker, host)", giver.worker);
    while (row.step()) held.push_back(row.integer(0));
  }
  for (const std::int64_t id : held) {
    const TaskRow task = *find_task(tx.db, id);
    release_task(tx, task);
    settle_job(tx, task.job_id);
  }
  // Nor does it come back to a lease that is late, or repeat the report of a block that it has finished.
  tx.db.run(
      "UPDATE tasks SET token = NULL, late_token = NULL WHERE ? IN (worker, host)"
      " AND state IN ('pending', 'done')",
      giver.worker);
}

}  // namespace

void distrust(Tx& tx, const JobRow& job, const std::string& who) {
  if (job.core_version.empty() || job.removed_ms > 0) {
    throw StoreError(StoreError::Code::kPrecondition, "job " + job.id + " has no field yet");
  }
  bool is_host = false;
  std::vector<Giver> givers = named(tx.db, job, who, is_host);
  tx.require_room();
  const std::vector<Range> given = given_by(tx.db, job.erosion_id, givers);
  const DirectionPositions positions(
      job.directions, tx.db.integer("SELECT stride FROM erosions WHERE id = ?", job.erosion_id).value_or(1));
  const std::int64_t removed = remove_values(tx.db, job.erosion_id, job.points, [&](std::uint32_t direction) {
    return contains(given, positions.position(direction));
  });
  undo(tx.db, job.erosion_id, removed > 0 ? std::vector<Range>{{0, job.directions}} : given);
  for (const Giver& giver : givers) {
    tx.db.run("DELETE FROM given_ranges WHERE erosion_id = ? AND worker = ?", job.erosion_id, giver.worker);
    add_event(
        tx, job.id,
        {.event = "distrusted",
         .worker = giver.worker,
         .message = base::counted(removed, "value") + " taken out, " +
                    (removed > 0 ? "all directions" : "its directions") + " are computed again" +
                    (job.refines ? ", and the refinement begins anew" : "") + "; it gets no more work"});
  }
  if (is_host) {
    givers.push_back({who, who});
    add_event(
        tx, job.id,
        {.event = "distrusted",
         .message = "no worker of host " + base::quoted(who) + " gets work until affskel-server trust"});
  }
  tx.db.run("DELETE FROM verifications WHERE job_id = ?", job.id);
  restart_erosion(tx, job.erosion_id, job.directions);
  for (const Giver& giver : givers) bar(tx, giver);
  tx.changes.work = true;
}

std::set<std::string> distrusted(Database& db) {
  Statement row = db.query("SELECT worker FROM distrusted");
  std::set<std::string> names;
  while (row.step()) names.insert(row.text(0));
  return names;
}

void require_trusted(Database& db, const v1::WorkerIdentity& worker) {
  const auto refuse_if = [&db](const std::string& name, const std::string& why) {
    if (!db.integer("SELECT 1 FROM distrusted WHERE worker = ?", name)) return;
    throw StoreError(StoreError::Code::kForbidden, "an administrator distrusts " + why);
  };
  refuse_if(worker.id(), "this worker; look after its machine before it is started anew");
  refuse_if(worker.host(),
            "all workers of this host; look after the machine, and run affskel-server trust on the server's");
}

void trust(Database& db, const std::string& host) {
  if (db.run("DELETE FROM distrusted WHERE host = ?", host) > 0) return;
  std::string hosts;
  Statement row = db.query("SELECT DISTINCT host FROM distrusted ORDER BY host");
  while (row.step()) hosts += (hosts.empty() ? "" : ", ") + base::quoted(row.text(0));
  throw StoreError(StoreError::Code::kNotFound,
                   "nobody distrusts the host " + base::quoted(host) +
                       (hosts.empty() ? ", nor any other" : "; distrusted, or with such workers: " + hosts));
}

}  // namespace affskel::server

// How long what is finished is kept: pins, and the steps of retention.

#include "database/errors.h"
#include "store/job_events.h"
#include "store/retention.h"
#include "store/store_impl.h"

namespace affskel::server {
namespace {

// Of a step: a few milliseconds, in which workers wait.
constexpr std::size_t kRemovalsInAStep = 20;
constexpr std::size_t kPlansInAStep = 100;

}  // namespace

v1::Job Store::pin(const JobRef& job_ref, bool pinned) {
  return write_job(job_ref, [pinned](Tx& tx, const JobRow& job) {
    if (job.pinned == pinned) return;
    tx.db.run("UPDATE jobs SET pinned = ?2, expires_ms = 0 WHERE id = ?1", job.id, pinned);
    tx.changes.jobs.insert(job.id);
    add_event(tx, job.id, {.event = pinned ? "pinned" : "unpinned"});
  });
}

bool Store::retain() {
  const std::int64_t now = clock_.wall_ms();
  const std::vector<std::string> due =
      read([&](Database& db) { return removals_due(db, now, kRemovalsInAStep); });
  if (!due.empty()) {
    return write([&](Tx& tx) {
      for (const std::string& job : due) {
        // It may have been deleted meanwhile.
        if (tx.db.integer("SELECT 1 FROM jobs WHERE id = ? AND expires_ms > 0", job))
          carry_out_removal(tx, job);
      }
      return true;
    });
  }
  const std::vector<Removal> removals =
      read([&](Database& db) { return removals_to_plan(db, options_.policy, now, kPlansInAStep); });
  if (removals.empty()) return false;
  return write([&](Tx& tx) {
    plan_removals(tx, removals);
    return true;
  });
}

}  // namespace affskel::server

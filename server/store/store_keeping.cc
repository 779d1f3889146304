// What is kept with a job: how its solid stands; and how long what is finished is kept: pins, and the steps of retention.

#include "database/errors.h"
#include "store/job_events.h"
#include "store/retention.h"
#include "store/store_impl.h"

namespace affskel::server {
namespace {

// Of a step: a few milliseconds, in which workers wait.
constexpr std::size_t kRemovalsInAStep = 20;
constexpr std::size_t kPlansInAStep = 100;

// 0: none; else its axis, 1 .. 3.
int axis_of(v1::AxisDirection direction) {
  return (int{direction} + 1) / 2;
}

void check_stance(const v1::Stance& stance) {
  const int up = axis_of(stance.up()), front = axis_of(stance.front());
  if (!v1::AxisDirection_IsValid(stance.up()) || !v1::AxisDirection_IsValid(stance.front()) ||
      (up == 0) != (front == 0) || (up != 0 && up == front)) {
    throw StoreError(StoreError::Code::kInvalid,
                     "stance: what is up and what is in front must be directions along different axes");
  }
}

}  // namespace

v1::Job Store::pin(const JobRef& job_ref, bool pinned) {
  return write_job(job_ref, [pinned](Tx& tx, const JobRow& job) {
    if (job.pinned == pinned) return;
    tx.db.run("UPDATE jobs SET pinned = ?2, expires_ms = 0 WHERE id = ?1", job.id, pinned);
    tx.changes.jobs.insert(job.id);
    add_event(tx, job.id, {.event = pinned ? "pinned" : "unpinned"});
  });
}

v1::Job Store::set_stance(const JobRef& job_ref, const v1::Stance& stance) {
  check_stance(stance);
  return write_job(job_ref, [&stance](Tx& tx, const JobRow& job) {
    tx.db.run("UPDATE jobs SET stance_up = ?2, stance_front = ?3 WHERE id = ?1", job.id, int{stance.up()},
              int{stance.front()});
    tx.changes.jobs.insert(job.id);
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

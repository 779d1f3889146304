// Changes that come while a transaction runs are made together by the next one, with one wait for the disk:
// the first of those that wait commits for all of them, in the order of their coming (LevelDB's queue of
// writers).

#include <algorithm>
#include <array>
#include <chrono>
#include <new>
#include <span>
#include <utility>

#include "database/errors.h"
#include "metrics/metrics.h"
#include "store/store.h"

namespace affskel::server {
namespace {

constexpr std::size_t kMaxTogether = 32;

}  // namespace

/// Makes a change; on a disk that turns out to be full once more, on what the reserve gives and for
/// bookkeeping only.
void Store::make(Change& change) {
  try {
    commit(change);
    return;
  } catch (const SqliteError& error) {
    if (error.primary_code() != SQLITE_FULL) throw;
    make_room(change.changes);
    if (!change.room) throw;  // it had the reserve already
  }
  change.room = false;
  commit(change);
}

/// Waits until a transaction with this change is on the disk.  @throws what the change threw, or the commit.
void Store::commit(Change& change) {
  change.alone = false;
  wait_for_turn(change);
  if (std::exchange(change.undone, false)) {
    change.alone = true;
    wait_for_turn(change);
  }
  if (change.error) std::rethrow_exception(std::exchange(change.error, nullptr));
}

void Store::wait_for_turn(Change& change) {
  base::MutexLock lock(turn_mutex_);
  change.ended = false;
  turns_.push_back(&change);
  change.woken.wait(lock, [&] {
    turn_mutex_.assert_held();
    return change.ended || turns_.front() == &change;
  });
  if (change.ended) return;
  std::array<Change*, kMaxTogether>
      first{};  // on the stack: what waits must leave the queue whatever happens
  const std::span together(first.data(), next_together());
  std::copy_n(turns_.begin(), together.size(), together.begin());
  lock.unlock();
  commit_together(together);
  lock.lock();
  for (Change* made : together) {
    turns_.pop_front();
    made->ended = true;
    made->woken.notify_one();
  }
  if (!turns_.empty()) turns_.front()->woken.notify_one();
}

/// Of those that wait, how many of the first may be made together.
std::size_t Store::next_together() const {
  if (turns_.front()->alone) return 1;
  const auto end = turns_.begin() + static_cast<std::ptrdiff_t>(std::min(turns_.size(), kMaxTogether));
  const auto apart = std::find_if(turns_.begin(), end, [](const Change* change) { return change->alone; });
  return static_cast<std::size_t>(apart - turns_.begin());
}

/// Runs the change.  One that is refused among others is undone alone, and keeps why: else whoever asks for what cannot be
/// would have theirs made again and again.
void Store::run_change(Change& change, bool among_others) {
  change.error = nullptr;
  change.changes = {};
  Tx tx{db_, options_, clock_.wall_ms(), clock_.lease_ms(), change.changes, change.room};
  if (!among_others) return change.body(tx);
  db_.run("SAVEPOINT change");
  try {
    change.body(tx);
  } catch (const StoreError&) {
    change.error = std::current_exception();
    change.changes = {};
    db_.run("ROLLBACK TO change");
  }
  db_.run("RELEASE change");
}

/// All of them or none: where the database fails, all are marked to be made alone.
void Store::commit_together(std::span<Change* const> together) {
  try {
    commit_all(together);
  } catch (...) {
    for (Change* change : together) change->undone = true;
    if (together.size() > 1) return;
    together.front()->undone = false;
    together.front()->error = std::current_exception();
  }
}

void Store::commit_all(std::span<Change* const> together) {
  const base::MutexLock lock(mutex_);
  const auto begun = std::chrono::steady_clock::now();
  // Not asked for what lives on the reserve: to ask may take it back.
  const bool room =
      std::any_of(together.begin(), together.end(), [](Change* change) { return change->room; }) &&
      has_room();
  Transaction transaction(db_);
  for (Change* change : together) {
    change->room = change->room && room;
    run_change(*change, together.size() > 1);
  }
  db_.claim_pages();
  transaction.commit();
  require_not_lost();
  const auto committed = std::chrono::steady_clock::now();
  for (Change* change : together) {
    const Changes& made = change->changes;
    if ((made.grown && !made.partly) || made.eased) reserve_.allow_retry();
    try {
      note_stuck(made);
      change->changes.counts.push_back([waited = begun - change->asked, worked = committed - begun](
                                           Metrics& metrics) { metrics.transaction(waited, worked); });
    } catch (const std::bad_alloc&) {
      // A count or a note is lost; what is committed must not be made again.
    }
  }
}

}  // namespace affskel::server

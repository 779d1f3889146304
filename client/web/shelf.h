#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <string>
#include <utility>

#include "base/mutex.h"
#include "client/web/random_key.h"

namespace affskel::client {

/// How much a shelf holds.
struct ShelfLimits {
  std::size_t of_session = 8;                    ///< things of one session; one more replaces its oldest
  std::size_t things = 512;                      ///< of all sessions
  std::uint64_t bytes = std::uint64_t{8} << 30;  ///< of all sessions, but for the newest thing
  std::chrono::seconds age{3600};                ///< since it was put there or last asked for
};

/// Things that belong to sessions and are found by keys that cannot be guessed, bounded in number, bytes and
/// age.  A thing that leaves the shelf lives on with its other holders.  Thread-safe.
template <typename Thing>
class Shelf {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Shelf(ShelfLimits limits, std::function<Clock::time_point()> now = Clock::now)
      : limits_(limits), now_(std::move(now)) {}

  /// @param bytes that the thing takes.  @return its key.
  std::string put(const std::string& session, std::shared_ptr<Thing> thing, std::uint64_t bytes) {
    std::list<Slot> gone;  // destroyed when the lock is released
    const base::MutexLock lock(mutex_);
    slots_.push_front({random_key(), session, std::move(thing), bytes, now_()});
    trim(gone);
    return slots_.front().key;
  }

  /// Null when it is not there (any more), or belongs to another session.
  std::shared_ptr<Thing> find(const std::string& session, const std::string& key) {
    std::list<Slot> gone;
    const base::MutexLock lock(mutex_);
    drop_old(gone);
    const auto found = std::find_if(slots_.begin(), slots_.end(), [&](const Slot& slot) {
      return slot.key == key && slot.session == session;
    });
    if (found == slots_.end()) return nullptr;
    found->used = now_();
    slots_.splice(slots_.begin(), slots_, found);
    return found->thing;
  }

  void drop_session(const std::string& session) {
    std::list<Slot> gone;
    const base::MutexLock lock(mutex_);
    move_if(gone, [&](const Slot& slot) { return slot.session == session; });
  }

 private:
  struct Slot {
    std::string key, session;
    std::shared_ptr<Thing> thing;
    std::uint64_t bytes;
    Clock::time_point used;
  };

  template <typename Predicate>
  void move_if(std::list<Slot>& gone, Predicate leaves) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    for (auto slot = slots_.begin(); slot != slots_.end();) {
      const auto next = std::next(slot);
      if (leaves(*slot)) gone.splice(gone.end(), slots_, slot);
      slot = next;
    }
  }

  void drop_old(std::list<Slot>& gone) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    const Clock::time_point oldest = now_() - limits_.age;
    move_if(gone, [&](const Slot& slot) { return slot.used < oldest; });
  }

  // The slots are ordered by their last use, so that what is beyond a limit are the longest unused.
  void trim(std::list<Slot>& gone) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    drop_old(gone);
    const std::string newest = slots_.front().session;
    std::size_t of_session = 0, things = 0;
    std::uint64_t bytes = 0;
    move_if(gone, [&](const Slot& slot) {
      const bool first = things == 0;
      if (slot.session == newest && ++of_session > limits_.of_session) return true;
      if (!first && (things + 1 > limits_.things || bytes + slot.bytes > limits_.bytes)) return true;
      ++things;
      bytes += slot.bytes;
      return false;
    });
  }

  const ShelfLimits limits_;
  const std::function<Clock::time_point()> now_;
  base::Mutex mutex_;
  std::list<Slot> slots_ ABSL_GUARDED_BY(mutex_);  // the last used first
};

}  // namespace affskel::client

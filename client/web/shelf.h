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

/// Things that belong to sessions and are found by keys that nobody can guess, bounded in number, bytes and
/// age. Whoever holds a thing keeps it when it leaves the shelf.  Thread-safe.
template <typename Thing>
class Shelf {
 public:
  using Clock = std::chrono::steady_clock;

  explicit Shelf(ShelfLimits limits, std::function<Clock::time_point()> now = Clock::now)
      : limits_(limits), now_(std::move(now)) {}

  /// @param bytes that the thing takes.  @return its key.
  std::string put(const std::string& session, std::shared_ptr<Thing> thing, std::uint64_t bytes) {
    std::list<Place> gone;  // destroyed when the lock is released
    const base::MutexLock lock(mutex_);
    places_.push_front({random_key(), session, std::move(thing), bytes, now_()});
    trim(gone);
    return places_.front().key;
  }

  /// Null when it is not there (any more), or belongs to another session.
  std::shared_ptr<Thing> find(const std::string& session, const std::string& key) {
    std::list<Place> gone;
    const base::MutexLock lock(mutex_);
    drop_old(gone);
    const auto found = std::find_if(places_.begin(), places_.end(), [&](const Place& place) {
      return place.key == key && place.session == session;
    });
    if (found == places_.end()) return nullptr;
    found->used = now_();
    places_.splice(places_.begin(), places_, found);
    return found->thing;
  }

  void drop_session(const std::string& session) {
    std::list<Place> gone;
    const base::MutexLock lock(mutex_);
    move_if(gone, [&](const Place& place) { return place.session == session; });
  }

 private:
  struct Place {
    std::string key, session;
    std::shared_ptr<Thing> thing;
    std::uint64_t bytes;
    Clock::time_point used;
  };

  template <typename Predicate>
  void move_if(std::list<Place>& gone, Predicate leaves) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    for (auto place = places_.begin(); place != places_.end();) {
      const auto next = std::next(place);
      if (leaves(*place)) gone.splice(gone.end(), places_, place);
      place = next;
    }
  }

  void drop_old(std::list<Place>& gone) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    const Clock::time_point oldest = now_() - limits_.age;
    move_if(gone, [&](const Place& place) { return place.used < oldest; });
  }

  // The places are ordered by their last use, so that what is beyond a limit are the longest unused.
  void trim(std::list<Place>& gone) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_) {
    drop_old(gone);
    const std::string newest = places_.front().session;
    std::size_t of_session = 0, things = 0;
    std::uint64_t bytes = 0;
    move_if(gone, [&](const Place& place) {
      const bool first = things == 0;
      if (place.session == newest && ++of_session > limits_.of_session) return true;
      if (!first && (things + 1 > limits_.things || bytes + place.bytes > limits_.bytes)) return true;
      ++things;
      bytes += place.bytes;
      return false;
    });
  }

  const ShelfLimits limits_;
  const std::function<Clock::time_point()> now_;
  base::Mutex mutex_;
  std::list<Place> places_ ABSL_GUARDED_BY(mutex_);  // the last used first
};

}  // namespace affskel::client

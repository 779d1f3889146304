#pragma once

#include <chrono>
#include <cstdint>
#include "base/mutex.h"

namespace affskel::server {

/// Counts client calls under way, for --idle-exit.  Thread-safe.
class Activity {
 public:
  /// A call under way, from construction to destruction.
  class Call {
   public:
    explicit Call(Activity& activity) : activity_(activity) { activity_.change(1); }
    ~Call() { activity_.change(-1); }
    Call(const Call&) = delete;
    Call& operator=(const Call&) = delete;

   private:
    Activity& activity_;
  };

  /// Time since the last call ended; 0 while one is under way.
  std::chrono::steady_clock::duration idle_time() const {
    const base::MutexLock lock(mutex_);
    return calls_ > 0 ? std::chrono::steady_clock::duration::zero()
                      : std::chrono::steady_clock::now() - last_;
  }

  /// Counts as a call that ends now: work was seen.
  void touch() { change(0); }

 private:
  void change(std::int64_t by) {
    const base::MutexLock lock(mutex_);
    calls_ += by;
    last_ = std::chrono::steady_clock::now();
  }

  mutable base::Mutex mutex_;
  std::int64_t calls_ ABSL_GUARDED_BY(mutex_) = 0;
  std::chrono::steady_clock::time_point last_ ABSL_GUARDED_BY(mutex_) = std::chrono::steady_clock::now();
};

}  // namespace affskel::server

#pragma once

#include <chrono>
#include <cstdint>
#include <mutex>

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
    const std::lock_guard lock(mutex_);
    return calls_ > 0 ? std::chrono::steady_clock::duration::zero()
                      : std::chrono::steady_clock::now() - last_;
  }

  /// Counts as a call that ends now: work was seen.
  void touch() { change(0); }

 private:
  void change(std::int64_t by) {
    const std::lock_guard lock(mutex_);
    calls_ += by;
    last_ = std::chrono::steady_clock::now();
  }

  mutable std::mutex mutex_;
  std::int64_t calls_ = 0;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

}  // namespace affskel::server

#pragma once

#include <cstdint>
#include <functional>
#include "base/mutex.h"

namespace affskel::server {

/// Time as the store sees it; tests inject their own.  Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;

  /// Unix milliseconds, for people.
  virtual std::int64_t wall_ms() const = 0;

  /// Milliseconds for lease deadlines.  Never goes back.  It counts the time in which this process was there
  /// to hear its workers: whatever stood still or jumped, the process, the machine or a clock, no lease has
  /// run out meanwhile.
  virtual std::int64_t lease_ms() const = 0;
};

/// Unix time and monotonic time of this machine, in milliseconds.
std::int64_t unix_ms();
std::int64_t monotonic_ms();

/// The clocks of this machine.
class SystemClock final : public Clock {
 public:
  /// Between two looks at the lease clock no more than this passes on it: the server looks every half second
  /// at least.
  static constexpr std::int64_t kLongestStepMs = 1000;

  /// @param monotonic what the lease clock counts along.
  explicit SystemClock(std::function<std::int64_t()> monotonic = monotonic_ms);
  std::int64_t wall_ms() const override;
  std::int64_t lease_ms() const override;

 private:
  const std::function<std::int64_t()> monotonic_;
  mutable base::Mutex mutex_;
  mutable std::int64_t seen_ms_ ABSL_GUARDED_BY(mutex_);
  mutable std::int64_t lease_ms_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server

#pragma once

#include <chrono>
#include <cstdint>
#include <optional>

#include "base/mutex.h"

namespace affskel::server {

/// What happens by the thousand is told in the log now and then, with its number.  Thread-safe.
class RareLog {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// @param pause between two lines.
  explicit RareLog(std::chrono::steady_clock::duration pause) : pause_(pause) {}

  /// It has happened.  @return how often since the last line, when another is due.
  std::optional<std::uint64_t> happened(Time now) {
    const base::MutexLock lock(mutex_);
    ++number_;
    if (told_ && now - *told_ < pause_) return std::nullopt;
    told_ = now;
    const std::uint64_t number = number_;
    number_ = 0;
    return number;
  }

 private:
  const std::chrono::steady_clock::duration pause_;
  base::Mutex mutex_;
  std::uint64_t number_ ABSL_GUARDED_BY(mutex_) = 0;
  std::optional<Time> told_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server

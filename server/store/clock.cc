#include "store/clock.h"
#include "base/mutex.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace affskel::server {
namespace {

template <typename C>
std::int64_t milliseconds_of() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(C::now().time_since_epoch()).count();
}

}  // namespace

std::int64_t unix_ms() {
  return milliseconds_of<std::chrono::system_clock>();
}

std::int64_t monotonic_ms() {
  return milliseconds_of<std::chrono::steady_clock>();
}

SystemClock::SystemClock(std::function<std::int64_t()> monotonic)
    : monotonic_(std::move(monotonic)), seen_ms_(monotonic_()), lease_ms_(unix_ms()) {}

std::int64_t SystemClock::wall_ms() const {
  return unix_ms();
}

std::int64_t SystemClock::lease_ms() const {
  const base::MutexLock lock(mutex_);
  const std::int64_t now = monotonic_();
  lease_ms_ += std::clamp<std::int64_t>(now - seen_ms_, 0, kLongestStepMs);
  seen_ms_ = now;
  return lease_ms_;
}

}  // namespace affskel::server

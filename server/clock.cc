#include "clock.h"

#include <chrono>

namespace affskel::server {
namespace {

template <typename C>
std::int64_t milliseconds_of() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(C::now().time_since_epoch()).count();
}

}  // namespace

SystemClock::SystemClock()
    : offset_ms_(milliseconds_of<std::chrono::system_clock>() -
                 milliseconds_of<std::chrono::steady_clock>()) {}

std::int64_t SystemClock::wall_ms() const {
  return milliseconds_of<std::chrono::system_clock>();
}

std::int64_t SystemClock::lease_ms() const {
  return offset_ms_ + milliseconds_of<std::chrono::steady_clock>();
}

}  // namespace affskel::server

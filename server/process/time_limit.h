#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace affskel::server {

/// For what may hang: does something about it unless this object is destroyed in time.
class TimeLimit {
 public:
  /// @param on_late called once, on another thread, when `limit` has passed.
  TimeLimit(std::chrono::milliseconds limit, std::function<void()> on_late);

 private:
  std::jthread thread_;
};

}  // namespace affskel::server

#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>

namespace affskel::tests {

/// Lets time pass where time itself is the subject: the pace of made-up people and workers, how long a load
/// or a fault lasts, the moment of a kill, the rest before a refused call is made again.  To wait for
/// something to happen there are better ways.
/// @param stop ends it at once.
inline void let_pass(std::chrono::nanoseconds time, const std::stop_token& stop = {}) {
  std::mutex mutex;
  std::condition_variable_any stopped;
  std::unique_lock lock(mutex);
  stopped.wait_for(lock, stop, time, [] { return false; });
}

}  // namespace affskel::tests

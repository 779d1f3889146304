#pragma once

#include <functional>
#include <thread>

namespace affskel::base {

/// SIGTERM and SIGINT, taken by a thread of their own at all times, so that they are answered whatever the
/// others do.  Construct before any other thread is started: the signals are blocked for all of them.
class StopSignals {
 public:
  /// @param on_stop called on that thread for each of them, with its number, when the end of the process has
  ///   its limit already (limit_end).
  /// @throws std::system_error when there can be no thread.
  explicit StopSignals(std::function<void(int)> on_stop);
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

 private:
  std::thread thread_;
};

}  // namespace affskel::base

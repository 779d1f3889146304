#pragma once

#include <stop_token>
#include <thread>

namespace affskel::worker {

/// Turns SIGTERM and SIGINT into a stop request.  Construct in main before any thread is started: the
/// signals are blocked for all threads and taken by one of its own.
class StopSignal {
 public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::thread thread_;
};

}  // namespace affskel::worker

#pragma once

#include <pthread.h>

#include <atomic>
#include <chrono>
#include <csignal>

#include "base/stop_signals.h"

namespace affskel::server {

/// What tells the server to leave.  Until begin_serving() that is done at once, by the thread that takes the
/// signal: the start may take long, or hang, and leaves nothing that the next one would not set right.  From
/// then on the main thread is told, and the end has its limit (base::limit_end).
///
/// Construct in the main thread, before any other is started.
class Signals {
 public:
  Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;

  void begin_serving() { serving_ = true; }

  /// Returns when one came, when a child ended, or after so long.  For the main thread.
  void wait(std::chrono::nanoseconds patience) const;

  /// How many came.
  unsigned count() const { return count_; }
  /// The latest.
  int number() const { return number_; }

 private:
  void take(int number);

  const pthread_t main_ = pthread_self();
  sigset_t waking_{};
  std::atomic<bool> serving_ = false;
  std::atomic<int> number_ = 0;
  std::atomic<unsigned> count_ = 0;
  base::StopSignals signals_;  // its thread uses the others
};

}  // namespace affskel::server

#pragma once

#include <ctime>

namespace affskel::bench {

inline double seconds_of(clockid_t clock) {
  timespec now{};
  clock_gettime(clock, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Seconds on the wall's clock since some moment.
inline double wall_now() {
  return seconds_of(CLOCK_MONOTONIC);
}
/// Processor seconds of this thread.
inline double thread_cpu_now() {
  return seconds_of(CLOCK_THREAD_CPUTIME_ID);
}
/// Processor seconds of all threads of this process.
inline double process_cpu_now() {
  return seconds_of(CLOCK_PROCESS_CPUTIME_ID);
}

}  // namespace affskel::bench

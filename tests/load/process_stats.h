#pragma once

#include <sys/types.h>

#include <cstdint>

namespace affskel::load {

/// What a process of this machine holds, of /proc.
struct ProcessStats {
  std::int64_t resident_kib = 0;
  std::int64_t peak_kib = 0;
  std::int64_t threads = 0;
  std::int64_t descriptors = 0;
  double cpu_s = 0;  ///< processor time so far, user and system
};

/// All zero when it is gone.
ProcessStats stats_of(pid_t pid);

}  // namespace affskel::load

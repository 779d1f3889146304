#pragma once

#include <cstdint>
#include <string>

#include "result.h"
#include "rows.h"

namespace affskel::bench {

struct MeasureOptions {
  double reference_s =
      0;  ///< processor seconds for timing the published program, see run_reference(); 0: do not
  bool two_threads = true;         ///< also on two threads, where one thread takes kLongJob or more
  std::uint64_t memory_limit = 0;  ///< bytes of address space for the row's process; 0: no limit
};

/// Jobs of at least this many seconds are long enough for a speed-up to mean something.
inline constexpr double kLongJob = 5;

/// Measures a row in a process of its own: the job on one thread, several times when it is short; its peak
/// memory after the first time; then the yardsticks and, for long jobs, two threads.  A row that fails
/// comes back with its error.
RowResult measure(const RowSpec& row, const std::string& off_file, const MeasureOptions& options);

/// The better of two measurements of the same row: the least time for every figure on its own.
RowResult better_of(const RowResult& a, const RowResult& b);

}  // namespace affskel::bench

#pragma once

#include <sys/resource.h>

#include <cstdint>
#include <new>
#include <string>

#include "client/cli/console.h"

namespace affskel::client {

/// What a file may take of this machine; 0: no limit.
struct Budgets {
  std::uint64_t read_limit_s = 600;     ///< processor time for reading it
  std::uint64_t repair_limit_s = 3600;  ///< processor time for mending and checking what it holds
  std::uint64_t memory = 0;             ///< bytes for each, beside what the process has by then
};

/// Ends the process with ExitCode::kLimit, and with a message that says which budget it met, when the work that is done
/// while this lives takes more; unfinished temporary files are removed.  From outside of the work, for libraries ask
/// nobody whether to stop.  One at a time.
class Budget {
 public:
  enum class Work { kReading, kRepair };

  /// @param file for messages.
  Budget(const Console& console, const Budgets& budgets, Work work, const std::string& file);
  ~Budget();
  Budget(const Budget&) = delete;
  Budget& operator=(const Budget&) = delete;

 private:
  rlimit data_{};  // as it was
  std::new_handler handler_ = nullptr;
  bool limits_memory_;
};

}  // namespace affskel::client

#pragma once

#include <chrono>

namespace affskel::base {

/// How a process leaves whose end hangs.
struct EndLimit {
  std::chrono::seconds limit{60};  ///< from limit_end() on
  const char* entry = "";          ///< of the log, as logfmt() makes them; kept by the caller for ever
  int exit_code = 70;
  /// Called before the process leaves, by a signal handler, on any thread; only async-signal-safe calls.
  void (*before)() noexcept = nullptr;
};

/// Prepares limit_end().  Once, at the start of main: all that a limit needs is had from then on.  Takes
/// SIGALRM and ITIMER_REAL for itself.
void set_end_limit(const EndLimit& limit);

/// From now on the process ends within the limit, whatever hangs: an end that has not come by then is made
/// by a signal handler, by _exit.  Only the first call counts, and none before set_end_limit().  Takes no
/// memory, no thread and no lock, since an end hangs for want of these; to be called by the code that ends
/// the process before anything that waits, by destructors too.  Async-signal-safe; any thread.
void limit_end() noexcept;

/// Writes an entry to stderr, with time and level before it, and leaves by _exit.  Async-signal-safe; any
/// thread.  An entry that stderr does not take at once, a pipe without a reader, is lost.
/// @param level of the log: "info", "critical".
[[noreturn]] void leave_at_once(const char* level, const char* entry, int exit_code) noexcept;

}  // namespace affskel::base

#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace affskel::chaos {

/// How a process is started.
struct Command {
  std::vector<std::string> arguments;    ///< the first is the program's path
  std::string out;                       ///< file for stdout, appended; empty = /dev/null
  std::string err;                       ///< file for stderr, appended; empty = /dev/null
  std::vector<std::string> environment;  ///< "NAME=value" on top of the present one
};

/// A process of our own; killed at the latest by the destructor, or by the kernel when the driver dies. Start
/// them in the driver's main thread only: the kernel takes the end of the starting thread for the driver's.
class Process {
 public:
  Process() = default;
  /// @throws std::runtime_error when no process can be made.
  explicit Process(const Command& command);
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;

  pid_t pid() const { return pid_; }

  /// Whether it was started and has not ended.
  bool alive() const;

  /// Sends a signal to it, if it was not waited for yet.
  void send(int signal) const;

  /// Waits for its end: the exit code, or 128 + signal; nothing when it is still there after `patience`.
  std::optional<int> wait(std::chrono::milliseconds patience);

  /// SIGKILL, then waits.
  void kill_hard();

  /// Waits until one of them has ended, for `patience` at most.  @returns whether one has; what was not
  /// started counts as ended.
  static bool one_ends(std::span<const Process> processes, std::chrono::milliseconds patience);

 private:
  void reap();

  pid_t pid_ = -1;
  int fd_ = -1;  // of the process, readable when it has ended
};

/// Runs to the end: the exit code, 128 + signal, or nothing when it took too long and was killed.
std::optional<int> run(const Command& command, std::chrono::milliseconds patience);

}  // namespace affskel::chaos

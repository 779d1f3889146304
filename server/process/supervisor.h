#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace affskel::server {

struct SupervisorOptions {
  unsigned workers = 0;
  std::vector<std::string> command;             ///< program (a path) and arguments of every worker
  std::chrono::milliseconds first_delay{100};   ///< before the restart of a worker that died young ...
  std::chrono::milliseconds last_delay{30000};  ///< ... doubled each time up to this
  std::chrono::milliseconds healthy{30000};     ///< a worker that lived this long starts again without delay
  /// Asked of one that ended with base::ExitCode::kNotAllowed, for which there are other reasons, too.
  std::function<bool(pid_t)> is_distrusted = [](pid_t) { return false; };
};

/// Keeps a number of child processes running, but for those that an administrator distrusts: another on the same
/// machine would be no better.  For one thread only, which must live as long as the children shall: they get SIGTERM
/// when the thread that started them ends, however it ends.
class Supervisor {
 public:
  using Callback = std::function<void(pid_t)>;

  /// @param on_start, on_end called for every child started and every child that has ended.
  Supervisor(SupervisorOptions options, Callback on_start, Callback on_end);
  /// Kills what terminate() has not ended.
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// Reaps children that have ended and starts those that are due.  Call on SIGCHLD and now and then.
  void tick();

  /// Sends SIGTERM to all and waits; kills workers that have not ended within `grace`.  Starts none
  /// afterwards.
  /// @param hurry asked again and again; true ends the grace.
  void terminate(
      std::chrono::milliseconds grace, const std::function<bool()>& hurry = [] { return false; });

  /// Kills all workers and does not wait, for a process that leaves at once.  Async-signal-safe; any thread.
  void kill_all() const noexcept;

  /// Children that run.
  unsigned running() const;

 private:
  using Time = std::chrono::steady_clock::time_point;
  struct Slot {
    std::atomic<pid_t> pid = 0;  // 0 = not running; read by kill_all()
    Time started;
    Time due;  // when to start next
    std::chrono::milliseconds delay{0};
    bool barred = false;  // its worker is distrusted, and another would be no better
  };

  void reap();
  void start(Slot& slot);
  void ended(Slot& slot);

  const SupervisorOptions options_;
  Callback on_start_;
  Callback on_end_;
  std::vector<Slot> slots_;
  bool terminating_ = false;
};

/// The worker program: `given`, else affskel-worker next to this program, else on the PATH.
/// @throws std::runtime_error when there is none.
std::string find_worker_binary(const std::string& given);

}  // namespace affskel::server

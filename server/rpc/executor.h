#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <thread>
#include <vector>
#include "base/mutex.h"

namespace affskel::server {

struct ExecutorOptions {
  std::size_t threads = 4;
};

/// Runs the parts of calls that may block, on a fixed number of threads.  Callers take turns,
/// so that one who posts a thousand bodies delays only himself.  Thread-safe.
class Executor {
 public:
  explicit Executor(const ExecutorOptions& options = {});
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Runs `body`, which must not throw, soon.  Bodies of one caller begin in the order of their coming, and
  /// may run side by side.  After stop() the body is run at once, by the caller's thread.
  /// @param caller whose turn it takes: a connection's number.
  void post(std::uint64_t caller, std::function<void()> body);

  /// Runs what was posted, and ends the threads.
  void stop();

 private:
  using Queue = std::deque<std::function<void()>>;

  void run();
  std::function<void()> take() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  base::Mutex mutex_;
  std::condition_variable_any changed_;
  std::map<std::uint64_t, Queue> queues_ ABSL_GUARDED_BY(mutex_);  // by caller; none is empty
  std::deque<std::uint64_t> turns_ ABSL_GUARDED_BY(mutex_);        // each caller that has a queue, once
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace affskel::server

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
  std::size_t calls = 8192;  ///< that wait, when callers with more than their share are refused
};

/// Runs the parts of calls that may block, on a fixed number of threads.  Callers take turns,
/// so that one that posts a thousand bodies delays only itself.  Thread-safe.
class Executor {
 public:
  explicit Executor(const ExecutorOptions& options = {});
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  /// Runs `body`, which must not throw, soon.  Bodies of one caller begin in the order of their coming, and
  /// may run side by side.  After stop() the body is run at once, by the caller's thread.
  /// @param caller whose turn it takes: a connection's number.
  /// @return what drop() knows it by.
  std::uint64_t post(std::uint64_t caller, std::function<void()> body);

  /// Whether a caller may post one more call: as long as there is room, or its share of the room is not full.
  bool has_room(std::uint64_t caller) const;

  /// Forgets a body that has not begun; false when it has.
  bool drop(std::uint64_t caller, std::uint64_t body);

  /// Bodies that wait.
  std::size_t waiting() const;

  /// Runs what was posted, and ends the threads.
  void stop();

 private:
  using Queue = std::map<std::uint64_t, std::function<void()>>;  // in the order of their coming

  void run();
  std::function<void()> take() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const ExecutorOptions options_;
  mutable base::Mutex mutex_;
  std::condition_variable_any changed_;
  std::map<std::uint64_t, Queue> queues_ ABSL_GUARDED_BY(mutex_);  // by caller; none is empty
  std::deque<std::uint64_t> turns_ ABSL_GUARDED_BY(mutex_);        // each caller that has a queue, once
  std::size_t waiting_ ABSL_GUARDED_BY(mutex_) = 0;
  std::uint64_t next_ ABSL_GUARDED_BY(mutex_) = 1;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace affskel::server

#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <utility>
#include "base/mutex.h"

namespace affskel::server {

/// Counts the calls that wait for what each task is to bring, so that a request without any is
/// taken back.  Thread-safe.
class ArtifactWaiters {
 public:
  /// Takes a task back; may block, must not throw.  False when that failed.
  using Withdraw = std::function<bool(std::int64_t task)>;

  explicit ArtifactWaiters(Withdraw withdraw) : withdraw_(std::move(withdraw)) {}

  /// One more waits for a task.  It may have been taken back just before: look after this whether it is
  /// still there.  Waits while it is being taken back.
  void join(std::int64_t task);

  /// One waits no more, for the task has ended or is gone.
  void leave(std::int64_t task);

  /// One gives up: the task is withdrawn when this was the last.
  void give_up(std::int64_t task);

  /// Takes back, once more, what could not be taken back, and what no call has joined since.
  void retry();

  /// From now on nothing is withdrawn: the server closes, and its successor decides.
  void close();

  /// How many wait for a task.
  std::size_t count(std::int64_t task) const;

 private:
  bool withdraw(std::int64_t task);
  bool leave_locked(std::int64_t task) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const Withdraw withdraw_;
  mutable base::Mutex mutex_;
  std::condition_variable_any withdrawn_;
  std::map<std::int64_t, std::size_t> waiting_ ABSL_GUARDED_BY(mutex_);  // by task
  std::set<std::int64_t> going_ ABSL_GUARDED_BY(mutex_);                 // tasks that are being taken back
  std::set<std::int64_t> left_ ABSL_GUARDED_BY(mutex_);                  // tasks that could not be taken back
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;
};

}  // namespace affskel::server

#pragma once

#include <atomic>
#include <functional>
#include <stop_token>

#include "core/base/execution_context.h"

namespace affskel::worker {

/// Whether a leased task is to be worked on still.  Any thread.
class TaskContext : public core::ExecutionContext {
 public:
  enum class Why {
    kGoesOn,
    kWorkerStops,  ///< SIGTERM: the lease is still ours, to be given back
    kCancelled,    ///< the server took the task away; its result is not wanted
    kLeaseLost,    ///< it ran out, or the job is gone
  };

  /// @param worker asks the whole worker to stop, and so this task.
  explicit TaskContext(const std::stop_token& worker)
      : on_worker_stop_(worker, [this] { stop(Why::kWorkerStops); }) {}

  /// The first reason stays.
  void stop(Why why) {
    Why none = Why::kGoesOn;
    why_.compare_exchange_strong(none, why);
    source_.request_stop();
  }

  Why why() const { return why_; }
  bool stop_requested() override { return why_ != Why::kGoesOn; }

  /// For calls to the server that are to end early, too.
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  std::atomic<Why> why_{Why::kGoesOn};
  std::stop_callback<std::function<void()>> on_worker_stop_;  // last: may call at once
};

}  // namespace affskel::worker

#pragma once

#include <chrono>
#include <ctime>
#include <stop_token>
#include <utility>

#include "core/base/execution_context.h"

namespace affskel::client {

/// Stops a computation when the browser no longer waits for its answer, or when it takes more processor time than it may.
class UntilGone final : public core::ExecutionContext {
 public:
  /// @param gone see http::Request. @param limit of the thread that makes this, from now on; 0: none.
  explicit UntilGone(std::stop_token gone, std::chrono::nanoseconds limit = {})
      : gone_(std::move(gone)), limit_(limit) {}
  bool stop_requested() override { return gone_.stop_requested() || met_limit(); }
  bool met_limit() const { return limit_.count() > 0 && thread_time() - begin_ > limit_; }

 private:
  static std::chrono::nanoseconds thread_time() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
  }

  const std::stop_token gone_;
  const std::chrono::nanoseconds limit_, begin_ = thread_time();
};

}  // namespace affskel::client

#pragma once

#include <stop_token>
#include <utility>

#include "core/base/execution_context.h"

namespace affskel::client {

/// Stops a computation when the browser no longer waits for its answer.
class UntilGone final : public core::ExecutionContext {
 public:
  /// @param gone see http::Request.
  explicit UntilGone(std::stop_token gone) : gone_(std::move(gone)) {}
  bool stop_requested() override { return gone_.stop_requested(); }

 private:
  const std::stop_token gone_;
};

}  // namespace affskel::client

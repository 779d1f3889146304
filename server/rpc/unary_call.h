#pragma once

#include <grpcpp/grpcpp.h>

#include <functional>
#include <optional>
#include <utility>

#include "rpc/call_room.h"
#include "rpc/call_timer.h"
#include "rpc/status.h"

namespace affskel::server {

/// A call with one request and one answer, whose body runs in an executor.
class UnaryCall final : public grpc::ServerUnaryReactor {
 public:
  /// @param body fills the answer; what it throws ends the call.  Does not run when the caller has gone.
  static grpc::ServerUnaryReactor* start(CallRoom& room, Executor& executor, Method method,
                                         const grpc::CallbackServerContext& context,
                                         std::function<void(const Identity&)> body) {
    auto* const call = new UnaryCall(room.metrics, method);
    const grpc::Status status = guarded([&] { call->scope_.emplace(room, context, method); });
    if (!status.ok()) {
      call->end(status);
      return call;
    }
    executor.post(call->scope_->caller().connection, [call, &context, body = std::move(body)] {
      const Identity& identity = call->scope_->caller().identity;
      call->end(context.IsCancelled() ? grpc::Status::CANCELLED : guarded([&] { body(identity); }));
    });
    return call;
  }

  void OnDone() override { delete this; }

 private:
  UnaryCall(Metrics& metrics, Method method) : timer_(metrics, method) {}

  void end(const grpc::Status& status) {
    timer_.ended(status);
    Finish(status);
  }

  const CallTimer timer_;
  std::optional<CallScope> scope_;
};

}  // namespace affskel::server

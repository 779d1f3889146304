#pragma once

#include <google/protobuf/message.h>
#include <grpcpp/grpcpp.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "calls/call_room.h"
#include "calls/call_timer.h"
#include "calls/status.h"

namespace affskel::server {

/// A call with one request and one answer, whose body runs in an executor.
class UnaryCall final : public grpc::ServerUnaryReactor,
                        public Endable,
                        public std::enable_shared_from_this<UnaryCall> {
 public:
  /// @param answer what `body` fills.
  /// @param body what it throws ends the call.  Does not run when the caller has gone.
  static grpc::ServerUnaryReactor* start(CallRoom& room, Executor& executor, Method method,
                                         grpc::CallbackServerContext& context,
                                         const google::protobuf::Message& answer,
                                         std::function<void(const Identity&)> body) {
    const std::shared_ptr<UnaryCall> call(new UnaryCall(room, executor, method, context, answer));
    call->self_ = call;
    const grpc::Status status = guarded([&] { call->post(std::move(body)); });
    if (!status.ok()) call->finish(status);
    return call.get();
  }

  /// The peer does not take the answer.
  void end(const grpc::Status&) override {
    const base::MutexLock lock(mutex_);
    if (!done_) context_.TryCancel();
  }

  /// Never after OnDone.
  void OnCancel() override {
    if (posted_ && executor_.drop(scope_->caller().connection, *posted_)) finish(grpc::Status::CANCELLED);
  }

  void OnDone() override {
    unread_.reset();
    const std::shared_ptr<UnaryCall> self = std::move(self_);  // the last use of this object
    const base::MutexLock lock(mutex_);
    done_ = true;
  }

 private:
  UnaryCall(CallRoom& room, Executor& executor, Method method, grpc::CallbackServerContext& context,
            const google::protobuf::Message& answer)
      : room_(room),
        executor_(executor),
        method_(method),
        context_(context),
        answer_(answer),
        timer_(room.metrics, method) {}

  void post(std::function<void(const Identity&)> body) {
    scope_.emplace(room_, context_, method_);
    const std::uint64_t connection = scope_->caller().connection;
    if (!executor_.has_room(connection))
      throw CallEnded({grpc::StatusCode::UNAVAILABLE,
                       "too many calls wait, and this caller has its share of them; try again"});
    posted_ = executor_.post(connection, [this, body = std::move(body)] { run(body); });
  }

  void run(const std::function<void(const Identity&)>& body) {
    const Caller& caller = scope_->caller();
    const grpc::Status status = context_.IsCancelled() ? grpc::Status::CANCELLED : guarded([&] {
      room_.answers.check(caller);  // now: many of its calls may have waited together
      body(caller.identity);
    });
    // What gRPC keeps: the message, and the message in the form that is sent.
    if (status.ok())
      unread_.emplace(
          room_.answers.enter(caller, answer_.SpaceUsedLong() + answer_.ByteSizeLong(), weak_from_this()));
    finish(status);
  }

  void finish(const grpc::Status& status) {
    timer_.ended(status);
    Finish(status);
  }

  CallRoom& room_;
  Executor& executor_;
  const Method method_;
  grpc::CallbackServerContext& context_;
  const google::protobuf::Message& answer_;
  const CallTimer timer_;
  std::optional<CallScope> scope_;
  std::optional<std::uint64_t> posted_;
  std::optional<Answers::Answer> unread_;
  base::Mutex mutex_;
  bool done_ ABSL_GUARDED_BY(mutex_) = false;  // with the context, too
  std::shared_ptr<UnaryCall> self_;
};

}  // namespace affskel::server

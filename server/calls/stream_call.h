#pragma once

#include <grpcpp/grpcpp.h>

#include <functional>
#include <memory>
#include <optional>

#include "base/mutex.h"
#include "calls/call_room.h"
#include "calls/call_timer.h"

namespace affskel::server {

/// The life of a stream, whichever way it goes.  It has bodies that run one after the other in an executor;
/// between them it waits, without a thread, until gRPC has moved a message or something else has happened.
/// It ends once, by a body, by its peer or by the server, and lives until gRPC is done with it.
class StreamCall : public Endable, public std::enable_shared_from_this<StreamCall> {
 public:
  void end(const grpc::Status& status) final;

  /// Makes a call and lets it begin.
  /// @return the reactor for gRPC.
  template <typename Call, typename... Arguments>
  static Call* begin(Arguments&&... arguments) {
    const auto call = std::make_shared<Call>(std::forward<Arguments>(arguments)...);
    StreamCall& stream = *call;
    {
      const base::MutexLock lock(stream.mutex_);
      stream.self_ = call;
    }
    stream.enter();
    return call.get();
  }

 protected:
  enum class After {
    kMove,  ///< gRPC moves the next message
    kWait,  ///< something else will run a body
    kEnd,   ///< the call has ended well
  };
  using Body = std::function<After()>;

  StreamCall(CallRoom& room, Executor& executor, grpc::CallbackServerContext& context, Method method)
      : room_(room), executor_(executor), context_(context), method_(method), timer_(room.metrics, method) {}
  ~StreamCall() override = default;

  CallRoom& room() { return room_; }
  const Caller& caller() const { return scope_->caller(); }
  /// Whether the peer has gone; for bodies.
  bool is_cancelled() const { return context_.IsCancelled(); }

  /// Runs a body soon, or when the one that is under way has come to wait; what it throws ends the call.
  void run(Body body);

  /// For the reactor: gRPC has moved a message, and `next` runs before any other body, unless the call is over.
  void moved(bool ok, Body next);
  /// For the reactor's OnDone: nothing of the object may be used afterwards.
  void done();

 private:
  /// The call begins: run(), or throw CallEnded.
  virtual After open() = 0;
  /// Starts to read or write a message.  Called with the lock held, by which it is not allowed to wait.
  virtual void move() = 0;
  /// Whether a message under way keeps gRPC from ending the call.
  virtual bool writes() const = 0;
  /// Tells gRPC the end.  Called once, with the lock held.
  virtual void send_status(const grpc::Status& status) = 0;
  /// gRPC is done with the call.
  virtual void ended() {}

  void enter();
  void post(Body body);
  void after(const grpc::Status& status, After what);
  void finish_if_free() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  CallRoom& room_;
  Executor& executor_;
  grpc::CallbackServerContext& context_;
  const Method method_;
  const CallTimer timer_;
  std::optional<CallScope> scope_;

  base::Mutex mutex_;
  bool busy_ ABSL_GUARDED_BY(mutex_) = false;      // a body runs, or is about to
  bool moving_ ABSL_GUARDED_BY(mutex_) = false;    // gRPC moves a message
  bool finished_ ABSL_GUARDED_BY(mutex_) = false;  // gRPC was told of the end
  Body next_ ABSL_GUARDED_BY(mutex_);              // to be run when the one under way has come to wait
  std::optional<grpc::Status> ending_ ABSL_GUARDED_BY(mutex_);
  std::shared_ptr<StreamCall> self_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server

#pragma once

#include <grpcpp/grpcpp.h>

#include <utility>

#include "calls/stream_call.h"

namespace affskel::server {

/// A call whose client sends many messages and gets one answer.  One message is in memory at a time: the
/// next is read when this one is dealt with.
template <typename Request>
class Receiving : public StreamCall, public grpc::ServerReadReactor<Request> {
 public:
  void OnReadDone(bool ok) final {
    place_.moved(ok ? message_.ByteSizeLong() : 0);
    moved(ok, [this, ok] { return ok ? receive() : finish(); });
  }
  void OnCancel() final { end(grpc::Status::CANCELLED); }
  void OnDone() final { done(); }

 protected:
  /// @param limit of the calls of this kind.
  Receiving(CallRoom& room, Executor& executor, grpc::CallbackServerContext& context, Method method,
            CallLimit& limit)
      : StreamCall(room, executor, context, method), limit_(limit) {}
  ~Receiving() override = default;

 private:
  /// The next message; the first one is the header.
  virtual void on_message(Request& message) = 0;
  /// The client has sent all, or was cut off.
  virtual void on_end() = 0;

  After open() final {
    place_ = limit_.enter(caller(), weak_from_this());
    return After::kMove;
  }
  After receive() {
    on_message(message_);
    message_ = Request();  // Clear() would keep its memory while the next one is awaited
    return After::kMove;
  }
  After finish() {
    on_end();
    return After::kEnd;
  }
  void move() final {
    place_.turn();
    this->StartRead(&message_);
  }
  bool writes() const final { return false; }
  void send_status(const grpc::Status& status) final { this->Finish(status); }
  void ended() final { place_.leave(); }

  CallLimit& limit_;
  CallLimit::Place place_;
  Request message_;
};

}  // namespace affskel::server

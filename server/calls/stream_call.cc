#include "calls/stream_call.h"

#include <utility>

#include "base/mutex.h"
#include "calls/status.h"

namespace affskel::server {

/// On gRPC's thread: nothing here blocks.
void StreamCall::enter() {
  {
    const base::MutexLock lock(mutex_);
    busy_ = true;
  }
  After what = After::kEnd;
  const grpc::Status status = guarded([&] {
    scope_.emplace(room_, context_, method_);
    what = open();
  });
  after(status, what);
}

void StreamCall::run(Body body) {
  {
    const base::MutexLock lock(mutex_);
    if (finished_ || ending_ || moving_) return;
    if (busy_) {
      next_.swap(body);  // the old one goes when the lock is gone
      return;
    }
    busy_ = true;
  }
  post(std::move(body));
}

void StreamCall::post(Body body) {
  executor_.post(caller().connection, [self = shared_from_this(), body = std::move(body)] {
    After what = After::kEnd;
    const grpc::Status status = guarded([&] { what = body(); });
    self->after(status, what);
  });
}

/// A body has come to its end.
void StreamCall::after(const grpc::Status& status, After what) {
  Body next;
  {
    const base::MutexLock lock(mutex_);
    busy_ = false;
    if (!ending_ && (!status.ok() || what == After::kEnd)) ending_ = status;
    next = std::exchange(next_, nullptr);
    if (ending_) {
      finish_if_free();
      return;
    }
    if (what == After::kMove) {
      moving_ = true;
      move();
      return;
    }
    if (next == nullptr) return;
    busy_ = true;
  }
  post(std::move(next));
}

void StreamCall::moved(bool ok, Body next) {
  {
    const base::MutexLock lock(mutex_);
    moving_ = false;
    if (finished_) return;
    if (!ok && writes() && !ending_) ending_ = grpc::Status::CANCELLED;
    if (ending_) {
      finish_if_free();
      return;
    }
    busy_ = true;  // with this lock: no other body may come between a message and what follows it
  }
  post(std::move(next));
}

void StreamCall::end(const grpc::Status& status) {
  const base::MutexLock lock(mutex_);
  if (finished_ || ending_) return;
  ending_ = status;
  finish_if_free();
}

void StreamCall::finish_if_free() {
  if (finished_ || busy_) return;
  if (moving_ && writes()) {
    context_.TryCancel();  // ends the write, and this is called once more
    return;
  }
  finished_ = true;
  timer_.ended(*ending_);
  send_status(*ending_);
}

void StreamCall::done() {
  ended();
  std::shared_ptr<StreamCall> self;  // destroyed when the lock is gone
  const base::MutexLock lock(mutex_);
  self = std::move(self_);
}

}  // namespace affskel::server

#include "services/watch.h"

#include <utility>

#include "base/mutex.h"
#include "database/errors.h"
#include "services/job_access.h"

namespace affskel::server {
namespace {

bool is_final(const v1::Job& job) {
  return job.state() == v1::JOB_STATE_DONE || job.state() == v1::JOB_STATE_FAILED ||
         job.state() == v1::JOB_STATE_CANCELLED;
}

}  // namespace

WatchCall::WatchCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store, EventHub& hub,
                     const v1::WatchJobRequest& request)
    : StreamCall(room, room.client_calls, context, Method::kWatchJob),
      store_(store),
      hub_(hub),
      job_(request.job()) {}

StreamCall::After WatchCall::open() {
  place_ = room().watches.enter(caller(), weak_from_this());
  run([this] {
    const std::string id = store_.resolve(job_ref(job_, caller().identity));
    const auto notify = [weak = weak_from_this()](const EventHub::JobPtr& job) {
      const auto self = std::static_pointer_cast<WatchCall>(weak.lock());
      if (self != nullptr) self->deliver(job);
    };
    subscription_ = hub_.subscribe(id, notify, true);
    return After::kWait;
  });
  return After::kWait;
}

/// On the hub's thread.
void WatchCall::deliver(const EventHub::JobPtr& job) {
  {
    const base::MutexLock lock(newest_mutex_);
    newest_ = job;
    deleted_ = job == nullptr;
  }
  run([this] { return next(); });
}

void WatchCall::OnWriteDone(bool ok) {
  moved(ok, [this] { return next(); });
}

StreamCall::After WatchCall::next() {
  const base::MutexLock lock(newest_mutex_);
  if (deleted_) throw StoreError(StoreError::Code::kNotFound, "the job was deleted");
  if (newest_ != nullptr) {
    sent_ = std::exchange(newest_, nullptr);
    return After::kMove;
  }
  return sent_ != nullptr && is_final(*sent_) ? After::kEnd : After::kWait;
}

}  // namespace affskel::server

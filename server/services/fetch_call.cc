#include "services/fetch_call.h"

#include <memory>
#include <utility>

#include "calls/status.h"
#include "database/errors.h"
#include "services/job_access.h"

namespace affskel::server {
namespace {

grpc::Status status_of_failure(const v1::JobError& error) {
  const grpc::StatusCode code = error.code() == "BAD_INPUT" ? grpc::StatusCode::INVALID_ARGUMENT
                                : error.code() == "LIMIT"   ? grpc::StatusCode::RESOURCE_EXHAUSTED
                                : error.code() == "DAMAGED" ? grpc::StatusCode::DATA_LOSS
                                                            : grpc::StatusCode::INTERNAL;
  return {code, error.message()};
}

}  // namespace

FetchCall::FetchCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store, const JobView& jobs,
                     EventHub& hub, ArtifactWaiters& waiters, const v1::FetchArtifactRequest& request)
    : Sending(room, room.client_streams, context, Method::kFetchArtifact),
      store_(store),
      jobs_(jobs),
      hub_(hub),
      waiters_(waiters),
      request_(request) {}

StreamCall::After FetchCall::open() {
  run([this] {
    // The full id from here on: "@last" may soon mean another job.
    request_.set_job(store_.resolve(job_ref(request_.job(), caller().identity)));
    // Before the first look: no change after it may be missed.
    subscription_ = hub_.subscribe(request_.job(), [weak = weak_from_this()](const EventHub::JobPtr&) {
      const auto self = std::static_pointer_cast<FetchCall>(weak.lock());
      if (self != nullptr) self->run([call = self.get()] { return call->ask(); });
    });
    return ask();
  });
  return After::kWait;
}

/// For a place among the downloads, before anything is opened.
StreamCall::After FetchCall::ask() {
  const std::weak_ptr<StreamCall> weak = weak_from_this();
  room().downloads.enter_later(caller(), weak,
                               [this, weak](const grpc::Status& status, CallLimit::Place place) {
                                 const auto alive = weak.lock();
                                 if (alive == nullptr) return;
                                 const auto held = std::make_shared<CallLimit::Place>(std::move(place));
                                 run([this, status, held] {
                                   if (!status.ok()) throw CallEnded(status);
                                   return look(std::move(*held));
                                 });
                               });
  return After::kWait;
}

StreamCall::After FetchCall::look(CallLimit::Place place) {
  Store::ArtifactState state = find();
  if (state.error || state.reader != nullptr) stop_waiting();
  if (state.error) throw CallEnded(status_of_failure(*state.error));
  if (state.reader != nullptr) {
    subscription_ = {};  // what changes from here on is not sent
    const v1::Job job = jobs_.with_reason(store_.job(request_.job()));
    return send(std::move(place), std::move(state.reader), &job);
  }
  place.leave();
  if (state.task == task_) {
    counted_ = true;
    return After::kWait;
  }
  wait_for(state.task);
  // Between finding the task and being counted, the last earlier waiter may have withdrawn it.
  return ask();
}

/// The artefact, or the task that will bring it.
Store::ArtifactState FetchCall::find() {
  if (task_ == 0 || counted_) return store_.open_artifact(request_, task_);
  try {
    return store_.open_artifact(request_, task_);
  } catch (const StoreError&) {
    stop_waiting();
    return store_.open_artifact(request_);
  }
}

void FetchCall::wait_for(std::int64_t task) {
  stop_waiting();
  waiters_.join(task);
  task_ = task;
  waiting_ = room().waiting.enter(caller(), weak_from_this());
}

/// The task has ended, or is gone.
void FetchCall::stop_waiting() {
  waiting_.leave();
  if (task_ != 0) waiters_.leave(std::exchange(task_, 0));
  counted_ = false;
}

void FetchCall::on_ended() {
  waiting_.leave();
  if (task_ == 0) return;
  // In the executor: taking it back is a transaction.
  room().client_streams.post(
      caller().connection, [&waiters = waiters_, task = std::exchange(task_, 0)] { waiters.give_up(task); });
}

}  // namespace affskel::server

#pragma once

#include <grpcpp/grpcpp.h>

#include <string>

#include "affskel/v1/client_service.grpc.pb.h"
#include "base/mutex.h"
#include "calls/stream_call.h"
#include "services/event_hub.h"
#include "store/store.h"

namespace affskel::server {

/// WatchJob.  At most one message is on its way; what changes meanwhile is sent next, newest only.
class WatchCall final : public StreamCall, public grpc::ServerWriteReactor<v1::Job> {
 public:
  WatchCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store, EventHub& hub,
            const v1::WatchJobRequest& request);

  void OnWriteDone(bool ok) override;
  void OnCancel() override { end(grpc::Status::CANCELLED); }
  void OnDone() override { done(); }

 private:
  After open() override;
  void deliver(const EventHub::JobPtr& job);
  After next();
  void move() override { StartWrite(sent_.get()); }
  bool writes() const override { return true; }
  void send_status(const grpc::Status& status) override { Finish(status); }
  void ended() override { place_.leave(); }

  Store& store_;
  EventHub& hub_;
  const std::string job_;
  CallLimit::Place place_;
  EventHub::Subscription subscription_;
  EventHub::JobPtr sent_;  // the one on its way, or the last that was

  base::Mutex newest_mutex_;
  EventHub::JobPtr newest_ ABSL_GUARDED_BY(newest_mutex_);  // not sent yet
  bool deleted_ ABSL_GUARDED_BY(newest_mutex_) = false;
};

}  // namespace affskel::server

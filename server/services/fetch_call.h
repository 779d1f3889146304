#pragma once

#include <cstdint>

#include "services/artifact_waiters.h"
#include "services/event_hub.h"
#include "services/job_view.h"
#include "services/sending.h"
#include "store/store.h"

namespace affskel::server {

/// FetchArtifact: sends what is stored; waits for what is yet to be made, and takes its request back when
/// its client does not want to wait any longer.
class FetchCall final : public Sending {
 public:
  FetchCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store, const JobView& jobs,
            EventHub& hub, ArtifactWaiters& waiters, const v1::FetchArtifactRequest& request);

 private:
  After open() override;
  void on_ended() override;

  After ask();
  After look(CallLimit::Place place);
  Store::ArtifactState find();
  void wait_for(std::int64_t task);
  void stop_waiting();

  Store& store_;
  const JobView& jobs_;
  EventHub& hub_;
  ArtifactWaiters& waiters_;
  v1::FetchArtifactRequest request_;
  EventHub::Subscription subscription_;
  // Of the bodies, and of the end:
  CallLimit::Place waiting_;
  std::int64_t task_ = 0;  // that it waits for
  bool counted_ = false;   // the task was still there when this call was counted among those that wait
};

}  // namespace affskel::server

#pragma once

#include <optional>

#include "affskel/v1/client_service.pb.h"
#include "calls/receiving.h"
#include "calls/upload.h"
#include "services/job_view.h"
#include "store/store.h"

namespace affskel::server {

/// SubmitJob: a header, then the mesh.
class SubmitCall final : public Receiving<v1::SubmitJobRequest> {
 public:
  SubmitCall(CallRoom& room, grpc::CallbackServerContext& context, Store& store, const JobView& jobs,
             v1::SubmitJobResponse& response)
      : Receiving(room, room.client_streams, context, Method::kSubmitJob, room.uploads),
        store_(store),
        jobs_(jobs),
        response_(response) {}

 private:
  void on_message(v1::SubmitJobRequest& message) override;
  void on_end() override;

  Store& store_;
  const JobView& jobs_;
  v1::SubmitJobResponse& response_;
  std::optional<Submission> submission_;
  std::optional<Upload> mesh_;
};

}  // namespace affskel::server

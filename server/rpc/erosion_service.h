#pragma once

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <string>

#include "affskel/v1/client_service.grpc.pb.h"
#include "rpc/activity.h"
#include "rpc/call_limit.h"
#include "rpc/event_hub.h"
#include "rpc/upload_budget.h"
#include "rpc/watch.h"
#include "rpc/worker_registry.h"
#include "store/store.h"

namespace affskel::server {

/// The service for clients.  WatchJob holds no thread; FetchArtifact holds one while it waits for a
/// derived artefact.
class ErosionServiceImpl final
    : public v1::ErosionService::WithCallbackMethod_WatchJob<v1::ErosionService::Service> {
 public:
  struct Facts {
    std::string data_dir;
    std::uint64_t started_ms = 0;
  };

  ErosionServiceImpl(Store& store, WorkerRegistry& registry, EventHub& hub, Activity& activity,
                     UploadBudget& uploads, const CallLimits& limits, Facts facts);

  grpc::Status SubmitJob(grpc::ServerContext* context, grpc::ServerReader<v1::SubmitJobRequest>* reader,
                         v1::SubmitJobResponse* response) override;
  grpc::Status GetJob(grpc::ServerContext* context, const v1::GetJobRequest* request,
                      v1::Job* response) override;
  grpc::Status ListJobs(grpc::ServerContext* context, const v1::ListJobsRequest* request,
                        v1::ListJobsResponse* response) override;
  grpc::ServerWriteReactor<v1::Job>* WatchJob(grpc::CallbackServerContext* context,
                                              const v1::WatchJobRequest* request) override;
  grpc::Status CancelJob(grpc::ServerContext* context, const v1::CancelJobRequest* request,
                         v1::Job* response) override;
  grpc::Status ResumeJob(grpc::ServerContext* context, const v1::ResumeJobRequest* request,
                         v1::Job* response) override;
  grpc::Status DeleteJob(grpc::ServerContext* context, const v1::DeleteJobRequest* request,
                         v1::DeleteJobResponse* response) override;
  grpc::Status FetchArtifact(grpc::ServerContext* context, const v1::FetchArtifactRequest* request,
                             grpc::ServerWriter<v1::FetchArtifactResponse>* writer) override;
  grpc::Status GetServerInfo(grpc::ServerContext* context, const v1::GetServerInfoRequest* request,
                             v1::ServerInfo* response) override;

  /// The job as it is now, with the reason why it waits; null when there is none.  Throws what the store
  /// throws otherwise.
  EventHub::JobPtr load(const std::string& job_id);

  /// Ends what waits.
  void stop();

 private:
  v1::Job with_reason(v1::Job job) const;
  /// An artefact to be sent, and the place among the downloads that this takes.
  struct Download {
    std::unique_ptr<CallLimit::Place> place;
    std::unique_ptr<BlobReader> reader;
  };
  Download wait_for_artifact(grpc::ServerContext& context, const v1::FetchArtifactRequest& request);

  Store& store_;
  WorkerRegistry& registry_;
  EventHub& hub_;
  Activity& activity_;
  UploadBudget& uploads_;
  const Facts facts_;
  CallLimit receiving_;
  CallLimit waiting_;
  CallLimit sending_;
  Watches watches_;
  std::atomic<bool> stopping_ = false;
};

}  // namespace affskel::server

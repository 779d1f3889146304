#pragma once

#include <grpcpp/grpcpp.h>

#include <cstdint>
#include <functional>
#include <string>

#include "affskel/v1/client_service.grpc.pb.h"
#include "calls/call_room.h"
#include "scheduling/worker_registry.h"
#include "services/artifact_waiters.h"
#include "services/event_hub.h"
#include "services/job_view.h"
#include "store/store.h"

namespace affskel::server {

/// The service for clients.  No call holds a thread while it waits.
class ErosionServiceImpl final : public v1::ErosionService::CallbackService {
 public:
  struct Facts {
    std::string data_dir;
    std::uint64_t started_ms = 0;
  };

  ErosionServiceImpl(CallRoom& room, Store& store, WorkerRegistry& registry, const JobView& jobs,
                     EventHub& hub, Facts facts);

  grpc::ServerReadReactor<v1::SubmitJobRequest>* SubmitJob(grpc::CallbackServerContext* context,
                                                           v1::SubmitJobResponse* response) override;
  grpc::ServerUnaryReactor* GetJob(grpc::CallbackServerContext* context, const v1::GetJobRequest* request,
                                   v1::Job* response) override;
  grpc::ServerUnaryReactor* ListJobs(grpc::CallbackServerContext* context, const v1::ListJobsRequest* request,
                                     v1::ListJobsResponse* response) override;
  grpc::ServerWriteReactor<v1::Job>* WatchJob(grpc::CallbackServerContext* context,
                                              const v1::WatchJobRequest* request) override;
  grpc::ServerUnaryReactor* CancelJob(grpc::CallbackServerContext* context,
                                      const v1::CancelJobRequest* request, v1::Job* response) override;
  grpc::ServerUnaryReactor* ResumeJob(grpc::CallbackServerContext* context,
                                      const v1::ResumeJobRequest* request, v1::Job* response) override;
  grpc::ServerUnaryReactor* PinJob(grpc::CallbackServerContext* context, const v1::PinJobRequest* request,
                                   v1::Job* response) override;
  grpc::ServerUnaryReactor* UnpinJob(grpc::CallbackServerContext* context, const v1::UnpinJobRequest* request,
                                     v1::Job* response) override;
  grpc::ServerUnaryReactor* SetStance(grpc::CallbackServerContext* context,
                                      const v1::SetStanceRequest* request, v1::Job* response) override;
  grpc::ServerUnaryReactor* ListJobEvents(grpc::CallbackServerContext* context,
                                          const v1::ListJobEventsRequest* request,
                                          v1::ListJobEventsResponse* response) override;
  grpc::ServerUnaryReactor* DeleteJob(grpc::CallbackServerContext* context,
                                      const v1::DeleteJobRequest* request,
                                      v1::DeleteJobResponse* response) override;
  grpc::ServerUnaryReactor* VerifyJob(grpc::CallbackServerContext* context,
                                      const v1::VerifyJobRequest* request,
                                      v1::Verification* response) override;
  grpc::ServerWriteReactor<v1::FetchArtifactResponse>* FetchArtifact(
      grpc::CallbackServerContext* context, const v1::FetchArtifactRequest* request) override;
  grpc::ServerUnaryReactor* GetServerInfo(grpc::CallbackServerContext* context,
                                          const v1::GetServerInfoRequest* request,
                                          v1::ServerInfo* response) override;

  /// Requests for artefacts that end from now on are left to the next server.
  void close() { waiters_.close(); }

  /// Takes requests back that no call waits for and that could not be taken back before, on a full disk say.
  void retry_withdrawals() { waiters_.retry(); }

 private:
  grpc::ServerUnaryReactor* answer(Method method, grpc::CallbackServerContext& context,
                                   const google::protobuf::Message& response,
                                   std::function<void(const Identity&)> body);
  void list(const Identity& caller, const v1::ListJobsRequest& request, v1::ListJobsResponse& response);
  void describe_server(const Identity& caller, v1::ServerInfo& response);

  CallRoom& room_;
  Store& store_;
  WorkerRegistry& registry_;
  const JobView& jobs_;
  EventHub& hub_;
  const Facts facts_;
  ArtifactWaiters waiters_;
};

}  // namespace affskel::server

#pragma once

#include <grpcpp/grpcpp.h>

#include "affskel/v1/worker_service.grpc.pb.h"
#include "calls/call_room.h"
#include "scheduling/bounds_exchange.h"
#include "scheduling/lease_queue.h"
#include "scheduling/worker_registry.h"
#include "store/store.h"

namespace affskel::server {

/// The service for workers.  No call holds a thread while it waits for its worker.
class WorkerServiceImpl final : public v1::WorkerService::CallbackService {
 public:
  WorkerServiceImpl(CallRoom& room, Store& store, WorkerRegistry& registry, LeaseQueue& queue,
                    BoundsExchange& bounds)
      : room_(room), store_(store), registry_(registry), queue_(queue), bounds_(bounds) {}

  grpc::ServerUnaryReactor* LeaseTask(grpc::CallbackServerContext* context,
                                      const v1::LeaseTaskRequest* request,
                                      v1::LeaseTaskResponse* response) override;
  grpc::ServerUnaryReactor* RenewLease(grpc::CallbackServerContext* context,
                                       const v1::RenewLeaseRequest* request,
                                       v1::ReportResponse* response) override;
  grpc::ServerReadReactor<v1::ReportErosionRequest>* ReportErosion(grpc::CallbackServerContext* context,
                                                                   v1::ReportResponse* response) override;
  grpc::ServerReadReactor<v1::CompleteTaskRequest>* CompleteTask(grpc::CallbackServerContext* context,
                                                                 v1::ReportResponse* response) override;
  grpc::ServerUnaryReactor* FailTask(grpc::CallbackServerContext* context, const v1::FailTaskRequest* request,
                                     v1::ReportResponse* response) override;
  grpc::ServerUnaryReactor* ReturnLease(grpc::CallbackServerContext* context,
                                        const v1::ReturnLeaseRequest* request,
                                        v1::ReportResponse* response) override;
  grpc::ServerWriteReactor<v1::FetchArtifactResponse>* FetchInput(
      grpc::CallbackServerContext* context, const v1::FetchInputRequest* request) override;

 private:
  template <typename Body>
  grpc::ServerUnaryReactor* with_lease_of(Method method, grpc::CallbackServerContext& context,
                                          const google::protobuf::Message& response, const std::string& token,
                                          Body body);

  CallRoom& room_;
  Store& store_;
  WorkerRegistry& registry_;
  LeaseQueue& queue_;
  BoundsExchange& bounds_;
};

}  // namespace affskel::server

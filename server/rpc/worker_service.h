#pragma once

#include <grpcpp/grpcpp.h>

#include "affskel/v1/worker_service.grpc.pb.h"
#include "rpc/bounds_exchange.h"
#include "rpc/lease_queue.h"
#include "rpc/upload_budget.h"
#include "rpc/worker_registry.h"
#include "store/store.h"

namespace affskel::server {

/// The service for workers.  Only LeaseTask waits, and it holds no thread.
class WorkerServiceImpl final
    : public v1::WorkerService::WithCallbackMethod_LeaseTask<v1::WorkerService::Service> {
 public:
  WorkerServiceImpl(Store& store, WorkerRegistry& registry, LeaseQueue& queue, UploadBudget& uploads);

  grpc::ServerUnaryReactor* LeaseTask(grpc::CallbackServerContext* context,
                                      const v1::LeaseTaskRequest* request,
                                      v1::LeaseTaskResponse* response) override;
  grpc::Status RenewLease(grpc::ServerContext* context, const v1::RenewLeaseRequest* request,
                          v1::ReportResponse* response) override;
  grpc::Status ReportErosion(grpc::ServerContext* context,
                             grpc::ServerReader<v1::ReportErosionRequest>* reader,
                             v1::ReportResponse* response) override;
  grpc::Status CompleteTask(grpc::ServerContext* context, grpc::ServerReader<v1::CompleteTaskRequest>* reader,
                            v1::ReportResponse* response) override;
  grpc::Status FailTask(grpc::ServerContext* context, const v1::FailTaskRequest* request,
                        v1::ReportResponse* response) override;
  grpc::Status ReturnLease(grpc::ServerContext* context, const v1::ReturnLeaseRequest* request,
                           v1::ReportResponse* response) override;
  grpc::Status FetchInput(grpc::ServerContext* context, const v1::FetchInputRequest* request,
                          grpc::ServerWriter<v1::FetchArtifactResponse>* writer) override;

 private:
  Store& store_;
  WorkerRegistry& registry_;
  LeaseQueue& queue_;
  UploadBudget& uploads_;
  BoundsExchange bounds_;
};

}  // namespace affskel::server

#include "services/worker_service.h"

#include "calls/unary_call.h"
#include "services/worker_calls.h"

namespace affskel::server {

/// A short call that uses a lease; `body` returns whether the lease has ended by it.
template <typename Body>
grpc::ServerUnaryReactor* WorkerServiceImpl::with_lease_of(Method method,
                                                           grpc::CallbackServerContext& context,
                                                           const google::protobuf::Message& response,
                                                           const std::string& token, Body body) {
  // The request, and so the token, lives as long as the call.
  return UnaryCall::start(
      room_, room_.worker_calls, method, context, response,
      [this, &token, body](const Identity&) { with_lease(room_, registry_, token, body); });
}

grpc::ServerUnaryReactor* WorkerServiceImpl::LeaseTask(grpc::CallbackServerContext* context,
                                                       const v1::LeaseTaskRequest* request,
                                                       v1::LeaseTaskResponse* response) {
  return queue_.lease(context, request, response);
}

grpc::ServerUnaryReactor* WorkerServiceImpl::RenewLease(grpc::CallbackServerContext* context,
                                                        const v1::RenewLeaseRequest* request,
                                                        v1::ReportResponse* response) {
  return with_lease_of(Method::kRenewLease, *context, *response, request->token(), [this, request, response] {
    *response = store_.renew(request->token());
    return response->cancelled();
  });
}

grpc::ServerReadReactor<v1::ReportErosionRequest>* WorkerServiceImpl::ReportErosion(
    grpc::CallbackServerContext* context, v1::ReportResponse* response) {
  return StreamCall::begin<ReportCall>(room_, *context, store_, registry_, bounds_, *response);
}

grpc::ServerReadReactor<v1::CompleteTaskRequest>* WorkerServiceImpl::CompleteTask(
    grpc::CallbackServerContext* context, v1::ReportResponse* response) {
  return StreamCall::begin<ResultCall>(room_, *context, store_, registry_, *response);
}

grpc::ServerUnaryReactor* WorkerServiceImpl::FailTask(grpc::CallbackServerContext* context,
                                                      const v1::FailTaskRequest* request,
                                                      v1::ReportResponse* response) {
  return with_lease_of(Method::kFailTask, *context, *response, request->token(), [this, request, response] {
    *response =
        store_.fail(request->token(), request->error(), request->retryable(), request->memory_needed());
    return true;
  });
}

grpc::ServerUnaryReactor* WorkerServiceImpl::ReturnLease(grpc::CallbackServerContext* context,
                                                         const v1::ReturnLeaseRequest* request,
                                                         v1::ReportResponse* response) {
  return with_lease_of(Method::kReturnLease, *context, *response, request->token(),
                       [this, request, response] {
                         *response = store_.give_back(request->token());
                         return true;
                       });
}

grpc::ServerWriteReactor<v1::FetchArtifactResponse>* WorkerServiceImpl::FetchInput(
    grpc::CallbackServerContext* context, const v1::FetchInputRequest* request) {
  return StreamCall::begin<InputCall>(room_, *context, store_, registry_, *request);
}

}  // namespace affskel::server

#include "rpc/worker_service.h"

#include "errors.h"
#include "rpc/status.h"
#include "rpc/streams.h"
#include "wire/limits.h"

namespace affskel::server {
namespace {

[[noreturn]] void refuse(const char* why) {
  throw StoreError(StoreError::Code::kInvalid, why);
}

void receive_records(grpc::ServerReader<v1::ReportErosionRequest>& reader, RecordBatch& batch) {
  v1::ReportErosionRequest message;
  while (reader.Read(&message)) {
    if (!message.has_records()) refuse("only records may follow the header of a report");
    if (message.records().point_size() > wire::kRecordsPerMessage)
      refuse("a message has at most 32768 records");
    batch.append(message.records());
  }
  batch.sort();
}

/// Runs a call that uses a lease.  The body returns whether the lease has ended by it; a fenced one has.
template <typename Body>
grpc::Status with_lease(WorkerRegistry& registry, const std::string& token, Body&& body) {
  registry.used(token);
  bool ended = false;
  const grpc::Status status = guarded([&] { ended = body(); });
  registry.used(token);  // a long report takes a while to arrive
  if (ended || status.error_code() == grpc::StatusCode::ABORTED) registry.ended(token);
  return status;
}

grpc::Status no_header() {
  return {grpc::StatusCode::INVALID_ARGUMENT, "the first message must be the header"};
}

}  // namespace

WorkerServiceImpl::WorkerServiceImpl(Store& store, WorkerRegistry& registry, LeaseQueue& queue,
                                     UploadBudget& uploads)
    : store_(store), registry_(registry), queue_(queue), uploads_(uploads) {}

grpc::ServerUnaryReactor* WorkerServiceImpl::LeaseTask(grpc::CallbackServerContext* context,
                                                       const v1::LeaseTaskRequest* request,
                                                       v1::LeaseTaskResponse* response) {
  return queue_.lease(context, request, response);
}

grpc::Status WorkerServiceImpl::RenewLease(grpc::ServerContext*, const v1::RenewLeaseRequest* request,
                                           v1::ReportResponse* response) {
  return with_lease(registry_, request->token(), [&] {
    *response = store_.renew(request->token());
    return response->cancelled();
  });
}

grpc::Status WorkerServiceImpl::ReportErosion(grpc::ServerContext* context,
                                              grpc::ServerReader<v1::ReportErosionRequest>* reader,
                                              v1::ReportResponse* response) {
  v1::ReportErosionRequest first;
  if (!reader->Read(&first) || !first.has_header()) return no_header();
  const v1::ReportErosionHeader& header = first.header();
  return with_lease(registry_, header.token(), [&] {
    if (header.bounds_for().size() > kMaxWorkerIdBytes) refuse("a worker's id has at most 64 bytes");
    const Store::ErodeLease lease = store_.erode_lease(header.token());
    RecordBatch batch(lease.points, lease.directions, header.records());
    receive_records(*reader, batch);
    // A stream that broke can look like one that ended; what it carried may be only half of a report.
    if (context->IsCancelled() || (header.has_records() && header.records() != batch.records().size())) {
      refuse("the report broke off: not all of its records arrived");
    }
    *response = store_.report(header, batch);
    if (!header.bounds_for().empty()) {
      bounds_.exchange(lease.job, header.bounds_for(), batch.records(), *response);
    }
    return response->cancelled() || header.block_done();
  });
}

grpc::Status WorkerServiceImpl::CompleteTask(grpc::ServerContext*,
                                             grpc::ServerReader<v1::CompleteTaskRequest>* reader,
                                             v1::ReportResponse* response) {
  v1::CompleteTaskRequest first;
  if (!reader->Read(&first) || !first.has_header()) return no_header();
  const v1::CompleteTaskHeader& header = first.header();
  return with_lease(registry_, header.token(), [&] {
    if (header.bytes() > wire::kMaxResultBytes) {
      throw StoreError(StoreError::Code::kLimit, "a result has at most 2^31 - 1 bytes");
    }
    UploadBudget::Share share(uploads_);
    const std::string data = receive_data<v1::CompleteTaskRequest>(*reader, header.bytes(), share);
    *response = store_.complete(header, data);
    return true;
  });
}

grpc::Status WorkerServiceImpl::FailTask(grpc::ServerContext*, const v1::FailTaskRequest* request,
                                         v1::ReportResponse* response) {
  return with_lease(registry_, request->token(), [&] {
    *response = store_.fail(request->token(), request->error(), request->retryable());
    return true;
  });
}

grpc::Status WorkerServiceImpl::ReturnLease(grpc::ServerContext*, const v1::ReturnLeaseRequest* request,
                                            v1::ReportResponse* response) {
  return with_lease(registry_, request->token(), [&] {
    *response = store_.give_back(request->token());
    return true;
  });
}

grpc::Status WorkerServiceImpl::FetchInput(grpc::ServerContext*, const v1::FetchInputRequest* request,
                                           grpc::ServerWriter<v1::FetchArtifactResponse>* writer) {
  return with_lease(registry_, request->token(), [&] {
    send_blob(*writer, *store_.open_input(request->token(), request->kind()));
    return false;
  });
}

}  // namespace affskel::server

#include "every_call.h"

#include "service_fixture.h"

namespace affskel::server {

std::vector<std::pair<std::string, std::function<grpc::Status(const std::shared_ptr<grpc::Channel>&)>>>
every_call(const std::string& job) {
  using Client = v1::ErosionService;
  using Worker = v1::WorkerService;
  const auto unary = [](auto method, auto request, auto response, auto make_stub) {
    return [=](const std::shared_ptr<grpc::Channel>& channel) mutable {
      grpc::ClientContext context;
      return (*make_stub(channel).*method)(&context, request, &response);
    };
  };
  const auto client = [](const std::shared_ptr<grpc::Channel>& channel) { return Client::NewStub(channel); };
  const auto worker = [](const std::shared_ptr<grpc::Channel>& channel) { return Worker::NewStub(channel); };
  const auto about = [&](auto request) {
    request.set_job(job);
    return request;
  };
  const auto leased = [&](auto request) {
    request.set_token("no lease");
    return request;
  };
  v1::LeaseTaskRequest lease;
  *lease.mutable_worker() = worker_identity();
  return {
      {"SubmitJob",
       [](const std::shared_ptr<grpc::Channel>& channel) {
         v1::SubmitJobResponse response;
         return submit_mesh(*Client::NewStub(channel), submit_header("OFF all"), "OFF all", &response);
       }},
      {"GetJob", unary(&Client::Stub::GetJob, about(v1::GetJobRequest()), v1::Job(), client)},
      {"ListJobs", unary(&Client::Stub::ListJobs, v1::ListJobsRequest(), v1::ListJobsResponse(), client)},
      {"WatchJob",
       [=](const std::shared_ptr<grpc::Channel>& channel) {
         grpc::ClientContext context;
         const auto stub = Client::NewStub(channel);
         const auto reader = stub->WatchJob(&context, about(v1::WatchJobRequest()));
         v1::Job seen;
         if (!reader->Read(&seen)) return reader->Finish();
         context.TryCancel();
         reader->Finish();
         return grpc::Status::OK;
       }},
      {"CancelJob", unary(&Client::Stub::CancelJob, about(v1::CancelJobRequest()), v1::Job(), client)},
      {"ResumeJob", unary(&Client::Stub::ResumeJob, about(v1::ResumeJobRequest()), v1::Job(), client)},
      {"PinJob", unary(&Client::Stub::PinJob, about(v1::PinJobRequest()), v1::Job(), client)},
      {"UnpinJob", unary(&Client::Stub::UnpinJob, about(v1::UnpinJobRequest()), v1::Job(), client)},
      {"SetStance", unary(&Client::Stub::SetStance, about(v1::SetStanceRequest()), v1::Job(), client)},
      {"DeleteJob",
       unary(&Client::Stub::DeleteJob, about(v1::DeleteJobRequest()), v1::DeleteJobResponse(), client)},
      {"ListJobEvents", unary(&Client::Stub::ListJobEvents, about(v1::ListJobEventsRequest()),
                              v1::ListJobEventsResponse(), client)},
      {"VerifyJob",
       unary(&Client::Stub::VerifyJob, about(v1::VerifyJobRequest()), v1::Verification(), client)},
      {"FetchArtifact",
       [=](const std::shared_ptr<grpc::Channel>& channel) {
         v1::FetchArtifactRequest request = about(v1::FetchArtifactRequest());
         request.set_kind(v1::ARTIFACT_KIND_MESH);
         return fetch(*Client::NewStub(channel), request).status;
       }},
      {"GetServerInfo",
       unary(&Client::Stub::GetServerInfo, v1::GetServerInfoRequest(), v1::ServerInfo(), client)},
      {"LeaseTask", unary(&Worker::Stub::LeaseTask, lease, v1::LeaseTaskResponse(), worker)},
      {"RenewLease",
       unary(&Worker::Stub::RenewLease, leased(v1::RenewLeaseRequest()), v1::ReportResponse(), worker)},
      {"ReportErosion",
       [](const std::shared_ptr<grpc::Channel>& channel) {
         grpc::ClientContext context;
         v1::ReportResponse response;
         const auto stub = Worker::NewStub(channel);
         const auto writer = stub->ReportErosion(&context, &response);
         v1::ReportErosionRequest message;
         message.mutable_header()->set_token("no lease");
         writer->Write(message);
         writer->WritesDone();
         return writer->Finish();
       }},
      {"CompleteTask",
       [](const std::shared_ptr<grpc::Channel>& channel) {
         v1::CompleteTaskHeader header;
         header.set_token("no lease");
         return send_result(*Worker::NewStub(channel), header, "");
       }},
      {"FailTask",
       unary(&Worker::Stub::FailTask, leased(v1::FailTaskRequest()), v1::ReportResponse(), worker)},
      {"ReturnLease",
       unary(&Worker::Stub::ReturnLease, leased(v1::ReturnLeaseRequest()), v1::ReportResponse(), worker)},
      {"FetchInput",
       [=](const std::shared_ptr<grpc::Channel>& channel) {
         grpc::ClientContext context;
         const auto stub = Worker::NewStub(channel);
         v1::FetchInputRequest request = leased(v1::FetchInputRequest());
         request.set_kind(v1::ARTIFACT_KIND_MESH);
         const auto reader = stub->FetchInput(&context, request);
         v1::FetchArtifactResponse part;
         while (reader->Read(&part)) {
         }
         return reader->Finish();
       }},
  };
}

}  // namespace affskel::server

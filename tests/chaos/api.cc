#include "api.h"

#include <algorithm>

#include "tools/let_pass.h"

namespace affskel::chaos {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kChunk = std::size_t{1} << 18;
// So long one attempt of a call that is repeated may take.
constexpr Milliseconds kAttempt{5000};
// Before a call is repeated: a server that refuses (a full disk, no place) does not tell when it will no
// longer.
constexpr Milliseconds kPause{20};

[[noreturn]] void break_off(const std::string& what, const grpc::Status& status) {
  throw Hang(what + ": " + status.error_message() + " (code " + std::to_string(status.error_code()) + ")");
}

void limit_to(grpc::ClientContext& context, Milliseconds limit) {
  context.set_wait_for_ready(true);
  context.set_deadline(std::chrono::system_clock::now() + limit);
}

// One of the calls whose request is a job's id.
template <typename Request, typename Response>
grpc::Status call_on_job(v1::ErosionService::Stub& stub,
                         grpc::Status (v1::ErosionService::Stub::*call)(grpc::ClientContext*, const Request&,
                                                                        Response*),
                         const std::string& id, Response& response, Milliseconds limit) {
  grpc::ClientContext context;
  limit_to(context, limit);
  Request request;
  request.set_job(id);
  return (stub.*call)(&context, request, &response);
}

v1::SubmitJobRequest header_of(const Submission& submission) {
  v1::SubmitJobRequest request;
  v1::SubmitJobHeader& header = *request.mutable_header();
  header.set_name(submission.name);
  header.set_owner("chaos");
  header.set_priority(submission.priority);
  *header.mutable_params() = submission.params;
  header.mutable_skeleton()->set_operator_(submission.skeleton);
  header.set_request_id(submission.request_id);
  header.set_mesh_sha256(submission.mesh_sha256);
  header.set_mesh_bytes(submission.mesh.size());
  return request;
}

}  // namespace

bool worth_repeating(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::UNAVAILABLE:
    case grpc::StatusCode::CANCELLED:
    case grpc::StatusCode::DEADLINE_EXCEEDED:
    case grpc::StatusCode::RESOURCE_EXHAUSTED:
    case grpc::StatusCode::INTERNAL:
    case grpc::StatusCode::UNKNOWN:
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::UNAUTHENTICATED:
      return true;
    default:
      return false;
  }
}

bool is_final(const v1::Job& job) {
  return job.state() == v1::JOB_STATE_DONE || job.state() == v1::JOB_STATE_FAILED ||
         job.state() == v1::JOB_STATE_CANCELLED;
}

Api::Api(const std::string& address, const wire::AccessFiles& access) {
  grpc::ChannelArguments arguments;
  arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 20);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 200);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  arguments.SetMaxReceiveMessageSize(16 << 20);
  const auto channel = wire::make_channel(wire::parse_address(address), access, arguments);
  client_ = v1::ErosionService::NewStub(channel);
  worker_ = v1::WorkerService::NewStub(channel);
}

grpc::Status Api::submit(const Submission& submission, v1::SubmitJobResponse& response,
                         Milliseconds limit) const {
  grpc::ClientContext context;
  limit_to(context, limit);
  response.Clear();
  const auto writer = client_->SubmitJob(&context, &response);
  bool open = writer->Write(header_of(submission));
  for (std::size_t from = 0; open && from < submission.mesh.size(); from += kChunk) {
    v1::SubmitJobRequest part;
    part.set_data(submission.mesh.substr(from, kChunk));
    open = writer->Write(part);
  }
  writer->WritesDone();
  return writer->Finish();
}

grpc::Status Api::job(const std::string& id, v1::Job& job, Milliseconds limit) const {
  return call_on_job(*client_, &v1::ErosionService::Stub::GetJob, id, job, limit);
}

grpc::Status Api::cancel(const std::string& id, v1::Job& job, Milliseconds limit) const {
  return call_on_job(*client_, &v1::ErosionService::Stub::CancelJob, id, job, limit);
}

grpc::Status Api::resume(const std::string& id, v1::Job& job, Milliseconds limit) const {
  return call_on_job(*client_, &v1::ErosionService::Stub::ResumeJob, id, job, limit);
}

grpc::Status Api::remove(const std::string& id, Milliseconds limit) const {
  v1::DeleteJobResponse response;
  return call_on_job(*client_, &v1::ErosionService::Stub::DeleteJob, id, response, limit);
}

grpc::Status Api::info(v1::ServerInfo& info, Milliseconds limit) const {
  grpc::ClientContext context;
  limit_to(context, limit);
  return client_->GetServerInfo(&context, {}, &info);
}

grpc::Status Api::list(std::vector<v1::Job>& jobs, Milliseconds limit) const {
  jobs.clear();
  v1::ListJobsRequest request;
  request.set_limit(1000);
  do {
    grpc::ClientContext context;
    limit_to(context, limit);
    v1::ListJobsResponse page;
    const grpc::Status status = client_->ListJobs(&context, request, &page);
    if (!status.ok()) return status;
    jobs.insert(jobs.end(), page.jobs().begin(), page.jobs().end());
    request.set_page_token(page.next_page_token());
  } while (!request.page_token().empty());
  return grpc::Status::OK;
}

grpc::Status Api::fetch(const v1::FetchArtifactRequest& request, std::string& bytes,
                        Milliseconds limit) const {
  grpc::ClientContext context;
  limit_to(context, limit);
  bytes.clear();
  v1::FetchArtifactResponse part;
  const auto reader = client_->FetchArtifact(&context, request);
  std::uint64_t promised = 0;
  while (reader->Read(&part)) {
    if (part.has_header()) promised = part.header().bytes();
    bytes += part.data();
  }
  const grpc::Status status = reader->Finish();
  if (status.ok() && bytes.size() != promised) {
    return {grpc::StatusCode::DATA_LOSS,
            "the artefact has " + std::to_string(bytes.size()) + " bytes, not " + std::to_string(promised)};
  }
  return status;
}

v1::Job Api::follow(const std::string& id, const std::function<bool(const v1::Job&)>& condition,
                    Milliseconds limit) const {
  const Clock::time_point give_up = Clock::now() + limit;
  v1::Job job;
  while (Clock::now() < give_up) {
    grpc::ClientContext context;
    limit_to(context, std::min(kAttempt, limit));
    v1::WatchJobRequest request;
    request.set_job(id);
    const auto reader = client_->WatchJob(&context, request);
    while (reader->Read(&job)) {
      if (!condition(job) && !is_final(job)) continue;
      context.TryCancel();
      reader->Finish();
      return job;
    }
    const grpc::Status status = reader->Finish();
    if (!status.ok() && !worth_repeating(status)) {
      throw Hang("job " + id + " cannot be followed: " + status.error_message());
    }
  }
  throw Hang("job " + id + " (" + job.name() + ") stands still in state " + v1::JobState_Name(job.state()) +
             ", stage " + v1::JobStage_Name(job.stage()) + ", " + std::to_string(job.directions_done()) +
             " directions done, waiting because \"" + job.waiting_reason() + "\"");
}

grpc::Status until_answered(const std::string& what, const std::function<grpc::Status()>& call) {
  const Clock::time_point give_up = Clock::now() + kPatience;
  for (;;) {
    const grpc::Status status = call();
    if (!worth_repeating(status)) return status;
    if (Clock::now() > give_up) break_off(what, status);
    tests::let_pass(kPause);
  }
}

v1::FetchArtifactRequest artefact(const std::string& job, v1::ArtifactKind kind) {
  v1::FetchArtifactRequest request;
  request.set_job(job);
  request.set_kind(kind);
  return request;
}

}  // namespace affskel::chaos

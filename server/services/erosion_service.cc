#include "services/erosion_service.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <string_view>
#include <utility>

#include "base/quoted.h"
#include "calls/status.h"
#include "calls/unary_call.h"
#include "database/errors.h"
#include "services/fetch_call.h"
#include "services/job_access.h"
#include "services/submit_call.h"
#include "services/watch.h"
#include "wire/limits.h"
#include "wire/version.h"

namespace affskel::server {
namespace {

constexpr std::uint32_t kDefaultListLimit = 50;

// Says what it is, so that something else does not pass for it by accident.
constexpr std::string_view kTokenPrefix = "before-";

std::string token_of_number(std::int64_t number) {
  return std::string(kTokenPrefix) + std::to_string(number);
}

/// 0 for no token.
std::int64_t number_of_token(const std::string& token) {
  if (token.empty()) return 0;
  std::int64_t number = 0;
  const std::string_view digits = std::string_view(token).substr(std::min(kTokenPrefix.size(), token.size()));
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (number < 1 || token != token_of_number(number)) {
    throw StoreError(StoreError::Code::kInvalid,
                     "page_token " + base::quoted(token) + " is no next_page_token of an earlier answer");
  }
  return number;
}

ListFilter filter_of(const v1::ListJobsRequest& request) {
  ListFilter filter;
  for (int state : request.states()) {
    if (!v1::JobState_IsValid(state) || state == v1::JOB_STATE_UNSPECIFIED) {
      throw StoreError(StoreError::Code::kInvalid, "unknown job state: " + std::to_string(state));
    }
    filter.states.push_back(static_cast<v1::JobState>(state));
  }
  filter.limit = request.limit() == 0 ? kDefaultListLimit : request.limit();
  if (filter.limit > wire::kMaxListedJobs)
    throw StoreError(StoreError::Code::kInvalid,
                     "the limit must be 1 .. 1000, or 0 for 50, not " + std::to_string(request.limit()));
  filter.before = number_of_token(request.page_token());
  return filter;
}

}  // namespace

ErosionServiceImpl::ErosionServiceImpl(CallRoom& room, Store& store, WorkerRegistry& registry,
                                       const JobView& jobs, EventHub& hub, Facts facts)
    : room_(room),
      store_(store),
      registry_(registry),
      jobs_(jobs),
      hub_(hub),
      facts_(std::move(facts)),
      waiters_([&store](std::int64_t task) { return guarded([&] { store.withdraw(task); }).ok(); }) {}

/// A short call.
grpc::ServerUnaryReactor* ErosionServiceImpl::answer(Method method, grpc::CallbackServerContext& context,
                                                     const google::protobuf::Message& response,
                                                     std::function<void(const Identity&)> body) {
  return UnaryCall::start(room_, room_.client_calls, method, context, response, std::move(body));
}

grpc::ServerReadReactor<v1::SubmitJobRequest>* ErosionServiceImpl::SubmitJob(
    grpc::CallbackServerContext* context, v1::SubmitJobResponse* response) {
  return StreamCall::begin<SubmitCall>(room_, *context, store_, jobs_, *response);
}

grpc::ServerUnaryReactor* ErosionServiceImpl::GetJob(grpc::CallbackServerContext* context,
                                                     const v1::GetJobRequest* request, v1::Job* response) {
  return answer(Method::kGetJob, *context, *response, [this, request, response](const Identity& caller) {
    *response = jobs_.with_reason(store_.job(job_ref(request->job(), caller)));
  });
}

grpc::ServerUnaryReactor* ErosionServiceImpl::ListJobs(grpc::CallbackServerContext* context,
                                                       const v1::ListJobsRequest* request,
                                                       v1::ListJobsResponse* response) {
  return answer(Method::kListJobs, *context, *response,
                [this, request, response](const Identity& caller) { list(caller, *request, *response); });
}

void ErosionServiceImpl::list(const Identity& caller, const v1::ListJobsRequest& request,
                              v1::ListJobsResponse& response) {
  ListFilter filter = filter_of(request);
  const std::optional<std::string> owner = listed_owner(request.owner(), caller);
  if (!owner) return;
  filter.owner = *owner;
  JobPage page = store_.list(filter);
  jobs_.add_reasons(page.jobs);
  for (v1::Job& job : page.jobs) *response.add_jobs() = std::move(job);
  if (page.next != 0) response.set_next_page_token(token_of_number(page.next));
}

grpc::ServerWriteReactor<v1::Job>* ErosionServiceImpl::WatchJob(grpc::CallbackServerContext* context,
                                                                const v1::WatchJobRequest* request) {
  return StreamCall::begin<WatchCall>(room_, *context, store_, hub_, *request);
}

grpc::ServerUnaryReactor* ErosionServiceImpl::CancelJob(grpc::CallbackServerContext* context,
                                                        const v1::CancelJobRequest* request,
                                                        v1::Job* response) {
  return answer(Method::kCancelJob, *context, *response, [this, request, response](const Identity& caller) {
    *response = jobs_.with_reason(store_.cancel(job_ref(request->job(), caller)));
  });
}

grpc::ServerUnaryReactor* ErosionServiceImpl::ResumeJob(grpc::CallbackServerContext* context,
                                                        const v1::ResumeJobRequest* request,
                                                        v1::Job* response) {
  return answer(Method::kResumeJob, *context, *response, [this, request, response](const Identity& caller) {
    const JobRef job = job_ref(request->job(), caller);
    if (request->distrust().empty()) {
      *response = jobs_.with_reason(store_.resume(job));
      return;
    }
    if (jobs_of(caller.role) != Jobs::kAll) {
      throw StoreError(StoreError::Code::kForbidden, "only an administrator distrusts a worker");
    }
    *response = jobs_.with_reason(store_.resume_without(job, request->distrust()));
  });
}

grpc::ServerUnaryReactor* ErosionServiceImpl::PinJob(grpc::CallbackServerContext* context,
                                                     const v1::PinJobRequest* request, v1::Job* response) {
  return answer(Method::kPinJob, *context, *response, [this, request, response](const Identity& caller) {
    *response = jobs_.with_reason(store_.pin(job_ref(request->job(), caller), true));
  });
}

grpc::ServerUnaryReactor* ErosionServiceImpl::UnpinJob(grpc::CallbackServerContext* context,
                                                       const v1::UnpinJobRequest* request,
                                                       v1::Job* response) {
  return answer(Method::kUnpinJob, *context, *response, [this, request, response](const Identity& caller) {
    *response = jobs_.with_reason(store_.pin(job_ref(request->job(), caller), false));
  });
}

grpc::ServerUnaryReactor* ErosionServiceImpl::SetStance(grpc::CallbackServerContext* context,
                                                        const v1::SetStanceRequest* request,
                                                        v1::Job* response) {
  return answer(Method::kSetStance, *context, *response, [this, request, response](const Identity& caller) {
    *response = jobs_.with_reason(store_.set_stance(job_ref(request->job(), caller), request->stance()));
  });
}

grpc::ServerUnaryReactor* ErosionServiceImpl::DeleteJob(grpc::CallbackServerContext* context,
                                                        const v1::DeleteJobRequest* request,
                                                        v1::DeleteJobResponse* response) {
  return answer(Method::kDeleteJob, *context, *response, [this, request, response](const Identity& caller) {
    response->set_id(store_.remove(job_ref(request->job(), caller)));
  });
}

grpc::ServerUnaryReactor* ErosionServiceImpl::ListJobEvents(grpc::CallbackServerContext* context,
                                                            const v1::ListJobEventsRequest* request,
                                                            v1::ListJobEventsResponse* response) {
  return answer(Method::kListJobEvents, *context, *response,
                [this, request, response](const Identity& caller) {
                  // What is greater than every number has no events after it.
                  const auto after = static_cast<std::int64_t>(
                      std::min<std::uint64_t>(request->after(), std::numeric_limits<std::int64_t>::max()));
                  *response = store_.events(job_ref(request->job(), caller), after);
                  if (jobs_of(caller.role) == Jobs::kAll) return;
                  for (v1::Giver& giver : *response->mutable_givers()) giver.clear_host();
                });
}

grpc::ServerUnaryReactor* ErosionServiceImpl::VerifyJob(grpc::CallbackServerContext* context,
                                                        const v1::VerifyJobRequest* request,
                                                        v1::Verification* response) {
  return answer(Method::kVerifyJob, *context, *response, [this, request, response](const Identity& caller) {
    const auto number = static_cast<std::int64_t>(
        std::min<std::uint64_t>(request->verification(), std::numeric_limits<std::int64_t>::max()));
    *response = store_.verify(job_ref(request->job(), caller), request->share(), number);
    jobs_.add_reason(*response);
    if (jobs_of(caller.role) == Jobs::kAll) return;
    for (v1::VerifiedSample& sample : *response->mutable_samples()) {
      for (v1::Giver& giver : *sample.mutable_givers()) giver.clear_host();
      sample.mutable_verifier()->clear_host();
    }
  });
}

grpc::ServerWriteReactor<v1::FetchArtifactResponse>* ErosionServiceImpl::FetchArtifact(
    grpc::CallbackServerContext* context, const v1::FetchArtifactRequest* request) {
  return StreamCall::begin<FetchCall>(room_, *context, store_, jobs_, hub_, waiters_, *request);
}

grpc::ServerUnaryReactor* ErosionServiceImpl::GetServerInfo(grpc::CallbackServerContext* context,
                                                            const v1::GetServerInfoRequest*,
                                                            v1::ServerInfo* response) {
  return answer(Method::kGetServerInfo, *context, *response,
                [this, response](const Identity& caller) { describe_server(caller, *response); });
}

/// Its own place, and the workers', are for admins, and so is what others have.
void ErosionServiceImpl::describe_server(const Identity& caller, v1::ServerInfo& response) {
  const bool sees_all = jobs_of(caller.role) == Jobs::kAll;
  const Store::Counts counts = sees_all ? store_.counts() : store_.counts_of(caller.owner);
  response.set_version(wire::kVersion);
  response.set_started_ms(facts_.started_ms);
  if (sees_all) {
    const DiskFigures disk = store_.disk_figures();
    response.set_pid(static_cast<std::uint32_t>(getpid()));
    response.set_data_dir(facts_.data_dir);
    response.set_database_bytes(static_cast<std::uint64_t>(disk.database_bytes + disk.log_bytes));
    if (disk.free_bytes) response.set_disk_free_bytes(*disk.free_bytes);
  }
  for (v1::WorkerInfo& worker : registry_.list()) {
    if (!sees_all) {
      worker.clear_task();
      worker.clear_host();
      worker.clear_pid();
    }
    *response.add_workers() = std::move(worker);
  }
  response.mutable_caller()->set_owner(caller.owner);
  response.mutable_caller()->set_role(caller.role);
  response.set_jobs_queued(static_cast<std::uint64_t>(counts.queued));
  response.set_jobs_running(static_cast<std::uint64_t>(counts.running));
  response.set_jobs_total(static_cast<std::uint64_t>(counts.total));
  response.set_schema_version(static_cast<std::uint64_t>(store_.schema_version()));
  response.set_max_mesh_bytes(store_.options().max_mesh_bytes);
}

}  // namespace affskel::server

#include "rpc/erosion_service.h"

#include <unistd.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <utility>

#include "errors.h"
#include "rpc/status.h"
#include "rpc/streams.h"
#include "wire/limits.h"
#include "wire/quoted.h"
#include "wire/version.h"

namespace affskel::server {
namespace {

constexpr std::uint32_t kDefaultListLimit = 50;

// How often a waiting fetch looks whether its client is still there; gRPC's synchronous calls are not
// told of it.
constexpr std::chrono::milliseconds kCancelCheck{200};

/// Set by the hub, waited for by a fetch.
struct Signal {
  std::mutex mutex;
  std::condition_variable changed;
  bool set = false;
};

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
                     "page_token " + wire::quoted(token) + " is no next_page_token of an earlier answer");
  }
  return number;
}

grpc::Status status_of_failure(const v1::JobError& error) {
  const grpc::StatusCode code = error.code() == "BAD_INPUT" ? grpc::StatusCode::INVALID_ARGUMENT
                                : error.code() == "LIMIT"   ? grpc::StatusCode::RESOURCE_EXHAUSTED
                                                            : grpc::StatusCode::INTERNAL;
  return {code, error.message()};
}

}  // namespace

ErosionServiceImpl::ErosionServiceImpl(Store& store, WorkerRegistry& registry, EventHub& hub,
                                       Activity& activity, UploadBudget& uploads, const CallLimits& limits,
                                       Facts facts)
    : store_(store),
      registry_(registry),
      hub_(hub),
      activity_(activity),
      uploads_(uploads),
      facts_(std::move(facts)),
      receiving_("uploads", limits.uploads, limits.patience, limits.stall),
      waiting_("waiting calls", limits.waiting, {}, {}),
      sending_("downloads", limits.downloads, limits.patience, limits.stall),
      watches_(hub, activity, limits.watches) {}

EventHub::JobPtr ErosionServiceImpl::load(const std::string& job_id) {
  try {
    return std::make_shared<const v1::Job>(with_reason(store_.job(job_id)));
  } catch (const StoreError& error) {
    if (error.code() == StoreError::Code::kNotFound) return nullptr;
    throw;
  }
}

v1::Job ErosionServiceImpl::with_reason(v1::Job job) const {
  const bool active = job.state() == v1::JOB_STATE_QUEUED || job.state() == v1::JOB_STATE_RUNNING;
  if (active && store_.disk_full()) {
    job.set_waiting_reason("the server's disk is full; it goes on when there is room");
    return job;
  }
  if (job.state() != v1::JOB_STATE_QUEUED || !job.waiting_reason().empty()) return job;
  std::vector<v1::WorkerInfo> workers = registry_.list();
  std::erase_if(workers, [](const v1::WorkerInfo& worker) { return worker.silent(); });
  const auto idle = [](const v1::WorkerInfo& worker) { return worker.task().empty(); };
  if (workers.empty()) {
    job.set_waiting_reason("no worker is connected");
  } else if (std::none_of(workers.begin(), workers.end(), idle)) {
    job.set_waiting_reason("all workers are busy with jobs before it");
  }
  return job;
}

grpc::Status ErosionServiceImpl::SubmitJob(grpc::ServerContext* context,
                                           grpc::ServerReader<v1::SubmitJobRequest>* reader,
                                           v1::SubmitJobResponse* response) {
  const Activity::Call call(activity_);
  return guarded([&] {
    CallLimit::Place place(receiving_);
    place.depend_on_client(*context);
    v1::SubmitJobRequest first;
    if (!reader->Read(&first) || !first.has_header()) {
      throw StoreError(StoreError::Code::kInvalid, "a submission begins with its header");
    }
    // Before the data, which may take minutes to arrive.
    const Submission submission = store_.check(first.header());
    UploadBudget::Share share(uploads_);
    const std::string mesh = receive_data<v1::SubmitJobRequest>(*reader, first.header().mesh_bytes(), share,
                                                                [&] { place.progress(); });
    Store::Submitted submitted = store_.submit(submission, mesh);
    *response->mutable_job() = with_reason(std::move(submitted.job));
    response->set_existed(submitted.existed);
  });
}

grpc::Status ErosionServiceImpl::GetJob(grpc::ServerContext*, const v1::GetJobRequest* request,
                                        v1::Job* response) {
  const Activity::Call call(activity_);
  return guarded([&] { *response = with_reason(store_.job(request->job())); });
}

grpc::Status ErosionServiceImpl::ListJobs(grpc::ServerContext*, const v1::ListJobsRequest* request,
                                          v1::ListJobsResponse* response) {
  const Activity::Call call(activity_);
  return guarded([&] {
    ListFilter filter;
    for (int state : request->states()) {
      if (!v1::JobState_IsValid(state) || state == v1::JOB_STATE_UNSPECIFIED) {
        throw StoreError(StoreError::Code::kInvalid, "unknown job state: " + std::to_string(state));
      }
      filter.states.push_back(static_cast<v1::JobState>(state));
    }
    filter.owner = request->owner();
    filter.limit = request->limit() == 0 ? kDefaultListLimit : request->limit();
    if (filter.limit > wire::kMaxListedJobs)
      throw StoreError(StoreError::Code::kInvalid,
                       "the limit must be 1 .. 1000, or 0 for 50, not " + std::to_string(request->limit()));
    filter.before = number_of_token(request->page_token());
    JobPage page = store_.list(filter);
    for (v1::Job& job : page.jobs) *response->add_jobs() = with_reason(std::move(job));
    if (page.next != 0) response->set_next_page_token(token_of_number(page.next));
  });
}

grpc::ServerWriteReactor<v1::Job>* ErosionServiceImpl::WatchJob(grpc::CallbackServerContext*,
                                                                const v1::WatchJobRequest* request) {
  std::string id;
  const grpc::Status status = guarded([&] { id = store_.resolve(request->job()); });
  return status.ok() ? watches_.watch(id) : refused_watch(status);
}

grpc::Status ErosionServiceImpl::CancelJob(grpc::ServerContext*, const v1::CancelJobRequest* request,
                                           v1::Job* response) {
  const Activity::Call call(activity_);
  return guarded([&] { *response = with_reason(store_.cancel(request->job())); });
}

grpc::Status ErosionServiceImpl::ResumeJob(grpc::ServerContext*, const v1::ResumeJobRequest* request,
                                           v1::Job* response) {
  const Activity::Call call(activity_);
  return guarded([&] { *response = with_reason(store_.resume(request->job())); });
}

grpc::Status ErosionServiceImpl::DeleteJob(grpc::ServerContext*, const v1::DeleteJobRequest* request,
                                           v1::DeleteJobResponse* response) {
  const Activity::Call call(activity_);
  return guarded([&] { response->set_id(store_.remove(request->job())); });
}

ErosionServiceImpl::Download ErosionServiceImpl::wait_for_artifact(grpc::ServerContext& context,
                                                                   const v1::FetchArtifactRequest& request) {
  const CallLimit::Place waiting(waiting_);
  const auto signal = std::make_shared<Signal>();
  const EventHub::Subscription subscription =
      hub_.subscribe(request.job(), [signal](const EventHub::JobPtr&) {
        {
          const std::lock_guard lock(signal->mutex);
          signal->set = true;
        }
        signal->changed.notify_all();
      });
  for (std::int64_t task = 0;;) {
    auto place = std::make_unique<CallLimit::Place>(sending_);
    Store::ArtifactState state = store_.open_artifact(request, task);
    if (state.error) throw CallEnded(status_of_failure(*state.error));
    if (state.reader != nullptr) return {std::move(place), std::move(state.reader)};
    place.reset();
    task = state.task;
    std::unique_lock lock(signal->mutex);
    while (!signal->changed.wait_for(lock, kCancelCheck, [&] { return signal->set; })) {
      if (context.IsCancelled()) throw CallEnded(grpc::Status::CANCELLED);
      if (stopping_) throw CallEnded({grpc::StatusCode::UNAVAILABLE, "the server is shutting down"});
    }
    signal->set = false;
  }
}

grpc::Status ErosionServiceImpl::FetchArtifact(grpc::ServerContext* context,
                                               const v1::FetchArtifactRequest* request,
                                               grpc::ServerWriter<v1::FetchArtifactResponse>* writer) {
  const Activity::Call call(activity_);
  return guarded([&] {
    // The full id from here on: "@last" may soon mean another job.
    v1::FetchArtifactRequest fixed = *request;
    fixed.set_job(store_.resolve(request->job()));
    const Download download = wait_for_artifact(*context, fixed);
    const v1::Job job = with_reason(store_.job(fixed.job()));
    download.place->depend_on_client(*context);
    send_blob(*writer, *download.reader, &job, [&] { download.place->progress(); });
  });
}

grpc::Status ErosionServiceImpl::GetServerInfo(grpc::ServerContext*, const v1::GetServerInfoRequest*,
                                               v1::ServerInfo* response) {
  const Activity::Call call(activity_);
  return guarded([&] {
    const Store::Counts counts = store_.counts();
    response->set_version(wire::kVersion);
    response->set_started_ms(facts_.started_ms);
    response->set_pid(static_cast<std::uint32_t>(getpid()));
    response->set_data_dir(facts_.data_dir);
    for (v1::WorkerInfo& worker : registry_.list()) *response->add_workers() = std::move(worker);
    response->set_jobs_queued(static_cast<std::uint64_t>(counts.queued));
    response->set_jobs_running(static_cast<std::uint64_t>(counts.running));
    response->set_jobs_total(static_cast<std::uint64_t>(counts.total));
    response->set_schema_version(static_cast<std::uint64_t>(store_.schema_version()));
    response->set_max_mesh_bytes(store_.options().max_mesh_bytes);
  });
}

void ErosionServiceImpl::stop() {
  stopping_ = true;
  watches_.stop();
}

}  // namespace affskel::server

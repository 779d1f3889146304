#include "client/connection/session.h"

#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <algorithm>
#include <optional>
#include <thread>

#include "client/connection/call_errors.h"
#include "client/connection/embedded_server.h"
#include "client/connection/health.h"
#include "wire/address.h"
#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::client {
namespace {

using Clock = std::chrono::steady_clock;

// How long to wait for the first answer of an embedded server.
constexpr std::chrono::milliseconds kStartPatience{10000};
// Shorter than what supervisors of containers give a health check.
constexpr std::chrono::milliseconds kHealthDeadline{3000};
constexpr int kMaxMessageBytes = 64 << 20;  // long job lists; pieces of streams are far smaller
// Servers refuse pings more often than every five minutes.
constexpr int kKeepaliveMs = 330 * 1000;

std::shared_ptr<grpc::Channel> channel_to(const wire::Address& address, const wire::AccessFiles& access) {
  grpc::ChannelArguments arguments;
  arguments.SetMaxReceiveMessageSize(kMaxMessageBytes);
  // A fresh channel must not inherit the connection back-off of the one it replaces.
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  if (address.is_local()) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  if (!address.is_unix) {
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
    arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, 20000);
  }
  try {
    return wire::make_channel(address, access, arguments);
  } catch (const std::invalid_argument& error) {
    throw ClientError(ExitCode::kUsage, error.what());
  }
}

// Cancels a call when its caller stops.
class CancelOnStop {
 public:
  CancelOnStop(grpc::ClientContext& context, const std::stop_token& stop)
      : on_stop_(stop, [&context] { context.TryCancel(); }) {}

 private:
  std::stop_callback<std::function<void()>> on_stop_;
};

// Counts and hashes what passes through.
class CheckedTransfer {
 public:
  CheckedTransfer(const v1::ArtifactHeader& header, ArtifactSink& sink) : header_(header), sink_(sink) {
    sink_.begin(header_);
  }
  void data(std::string_view bytes) {
    received_ += bytes.size();
    hash_.update(bytes);
    sink_.data(bytes);
  }
  void end() {
    if (received_ != header_.bytes()) {
      throw ClientError(ExitCode::kInternal, "the artefact was cut short: " + std::to_string(received_) +
                                                 " of " + std::to_string(header_.bytes()) + " bytes arrived");
    }
    if (const std::string digest = hash_.hex_digest(); digest != header_.sha256()) {
      throw ClientError(ExitCode::kInternal, "the artefact was damaged on its way: SHA-256 " + digest +
                                                 " instead of " + header_.sha256());
    }
    sink_.end();
  }

 private:
  v1::ArtifactHeader header_;
  ArtifactSink& sink_;
  wire::Sha256 hash_;
  std::uint64_t received_ = 0;
};

// Whether the server is away or closing.  A closing server cancels the calls that it no longer answers; this
// side never cancels one.
bool is_away(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::UNAVAILABLE ||
         status.error_code() == grpc::StatusCode::CANCELLED;
}

class MemorySink : public ArtifactSink {
 public:
  explicit MemorySink(std::string& bytes) : bytes_(bytes) {}
  void begin(const v1::ArtifactHeader&) override { bytes_.clear(); }
  void data(std::string_view bytes) override { bytes_.append(bytes); }
  void end() override {}

 private:
  std::string& bytes_;
};

grpc::Status fetch_once(v1::ErosionService::Stub& stub, const v1::FetchArtifactRequest& request,
                        ArtifactSink& sink, v1::ArtifactHeader& header, const RetryPolicy& policy) {
  grpc::ClientContext context;
  const CancelOnStop cancel(context, policy.stop);
  if (policy.artifact_patience.count() > 0)
    context.set_deadline(std::chrono::system_clock::now() + policy.artifact_patience);
  const auto reader = stub.FetchArtifact(&context, request);
  std::optional<CheckedTransfer> transfer;
  v1::FetchArtifactResponse message;
  try {
    while (reader->Read(&message)) {
      if (message.has_header() && !transfer) {
        header = message.header();
        transfer.emplace(header, sink);
      } else if (!message.has_header() && transfer) {
        transfer->data(message.data());
      } else {
        throw ClientError(ExitCode::kInternal, "the server sent the parts of the artefact out of order");
      }
    }
  } catch (...) {
    context.TryCancel();  // the stream must be finished before it is destroyed
    reader->Finish();
    throw;
  }
  grpc::Status status = reader->Finish();
  if (!status.ok()) return status;
  if (!transfer) throw ClientError(ExitCode::kInternal, "the server sent no artefact");
  transfer->end();
  return status;
}

grpc::Status submit_once(v1::ErosionService::Stub& stub, const v1::SubmitJobHeader& header,
                         std::string_view mesh, v1::SubmitJobResponse& response,
                         const std::stop_token& stop) {
  grpc::ClientContext context;
  const CancelOnStop cancel(context, stop);
  const auto bytes_per_second = std::size_t{1} << 20;
  context.set_deadline(std::chrono::system_clock::now() +
                       std::chrono::seconds(120 + mesh.size() / bytes_per_second));
  const auto writer = stub.SubmitJob(&context, &response);
  v1::SubmitJobRequest message;
  *message.mutable_header() = header;
  bool open = writer->Write(message);
  for (std::size_t begin = 0; open && begin < mesh.size(); begin += wire::kChunkBytes) {
    const std::string_view piece = mesh.substr(begin, wire::kChunkBytes);
    message.set_data(piece.data(), piece.size());
    open = writer->Write(message);
  }
  if (open) writer->WritesDone();
  return writer->Finish();
}

}  // namespace

bool is_final(v1::JobState state) {
  return state == v1::JOB_STATE_DONE || state == v1::JOB_STATE_FAILED || state == v1::JOB_STATE_CANCELLED;
}

Session::Session(ServerChoice choice, Environment environment, Console& console, RetryPolicy policy)
    : choice_(std::move(choice)), environment_(std::move(environment)), console_(console), policy_(policy) {}

Session::~Session() = default;

void Session::connect() {
  wire::Address address = choice_.address;
  if (choice_.embedded) {
    address = ensure_embedded_server(embedded_paths(environment_), {}, environment_, console_);
  }
  target_ = address.target();
  channel_ = channel_to(address, choice_.access);
  stub_ = v1::ErosionService::NewStub(channel_);
}

void Session::run(const std::function<grpc::Status(Stub&)>& attempt, ExitCode not_yet) {
  std::chrono::milliseconds pause = policy_.first_pause;
  std::optional<Clock::time_point> failing;  // since the first error: a call itself may take long
  while (true) {
    if (!stub_) connect();
    const grpc::Status status = attempt(*stub_);
    if (status.ok()) break;
    const bool away = is_away(status);
    // UNAVAILABLE over a connection that stands is the server's own answer.
    const bool busy = away && channel_->GetState(false) == GRPC_CHANNEL_READY;
    proven_ = proven_ || busy;
    if (!failing) failing = Clock::now();
    // An idle embedded server may leave at this very moment: another is started.
    const bool retries = proven_ || choice_.embedded;
    const auto patience = proven_ ? policy_.patience : std::min(policy_.patience, kStartPatience);
    const bool waits = away && retries && !policy_.stop.stop_requested();
    if (!waits || Clock::now() >= *failing + patience) fail(status, not_yet);
    if (busy) {
      tell_busy(status.error_message());
    } else {
      tell_away();
    }
    stub_.reset();
    std::this_thread::sleep_for(pause);
    pause = std::min(2 * pause, policy_.longest_pause);
  }
  proven_ = true;
  told_away_ = false;
}

void Session::fail(const grpc::Status& status, ExitCode not_yet) const {
  const ClientError error = error_from_status(status, target_, not_yet);
  if (!is_away(status) || choice_.embedded) throw error;
  throw ClientError(error.exit_code(), std::string(error.what()) + " (address from " + choice_.origin + ")");
}

void Session::tell_away() {
  if (proven_ && !told_away_) console_.note("the server went away; trying to reach it again");
  told_away_ = true;
}

void Session::tell_busy(const std::string& why) {
  if (!told_away_) console_.note("the server cannot answer now, trying again: " + why);
  told_away_ = true;
}

template <typename Request, typename Response>
Response Session::unary(const Request& request,
                        grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*)) {
  Response response;
  run([&](Stub& stub) {
    grpc::ClientContext context;
    const CancelOnStop cancel(context, policy_.stop);
    context.set_deadline(std::chrono::system_clock::now() + policy_.call_deadline);
    response.Clear();
    return (stub.*method)(&context, request, &response);
  });
  return response;
}

v1::Job Session::submit(const v1::SubmitJobHeader& header, std::string_view mesh, bool& existed) {
  v1::SubmitJobResponse response;
  run([&](Stub& stub) { return submit_once(stub, header, mesh, response, policy_.stop); });
  existed = response.existed();
  return response.job();
}

v1::Job Session::get_job(const std::string& job) {
  v1::GetJobRequest request;
  request.set_job(job);
  return unary(request, &Stub::GetJob);
}

v1::ListJobEventsResponse Session::job_events(const std::string& job) {
  v1::ListJobEventsRequest request;
  request.set_job(job);
  return unary(request, &Stub::ListJobEvents);
}

std::vector<v1::Job> Session::list_jobs(v1::ListJobsRequest request, std::size_t limit) {
  std::vector<v1::Job> jobs;
  while (jobs.size() < limit) {
    request.set_limit(
        static_cast<std::uint32_t>(std::min<std::size_t>(limit - jobs.size(), wire::kMaxListedJobs)));
    const v1::ListJobsResponse response = unary(request, &Stub::ListJobs);
    jobs.insert(jobs.end(), response.jobs().begin(), response.jobs().end());
    if (response.next_page_token().empty()) break;
    request.set_page_token(response.next_page_token());
  }
  return jobs;
}

grpc::Status Session::watch_once(Stub& stub, const v1::WatchJobRequest& request, v1::Job& last,
                                 const std::function<void(const v1::Job&)>& seen) {
  grpc::ClientContext context;
  const CancelOnStop cancel(context, policy_.stop);
  const auto reader = stub.WatchJob(&context, request);
  bool any = false;
  try {
    for (v1::Job now; reader->Read(&now);) {
      any = proven_ = true;
      told_away_ = false;
      last = now;
      seen(last);
    }
  } catch (...) {
    context.TryCancel();  // the stream must be finished before it is destroyed
    reader->Finish();
    throw;
  }
  grpc::Status status = reader->Finish();
  if (is_final(last.state())) return grpc::Status::OK;
  // Without a final state the stream ends only because the server shuts down.
  if (!status.ok() && !is_away(status)) return status;
  // After a message, patience begins anew.
  if (any) return grpc::Status::OK;
  return {grpc::StatusCode::UNAVAILABLE, status.ok() ? "the server ended the watch" : status.error_message()};
}

v1::Job Session::watch(const std::string& job, const std::function<void(const v1::Job&)>& seen) {
  v1::WatchJobRequest request;
  request.set_job(job);
  v1::Job last;
  while (true) {
    run([&](Stub& stub) { return watch_once(stub, request, last, seen); });
    if (is_final(last.state())) return last;
    request.set_job(last.id());  // "@last" may mean another job by now
    tell_away();
    stub_.reset();
    std::this_thread::sleep_for(policy_.first_pause);
  }
}

v1::Job Session::cancel(const std::string& job) {
  v1::CancelJobRequest request;
  request.set_job(job);
  return unary(request, &Stub::CancelJob);
}

v1::Job Session::resume(const std::string& job, const std::string& distrust) {
  v1::ResumeJobRequest request;
  request.set_job(job);
  request.set_distrust(distrust);
  return unary(request, &Stub::ResumeJob);
}

v1::Verification Session::verify(const std::string& job, double share, std::uint64_t verification) {
  v1::VerifyJobRequest request;
  request.set_job(job);
  request.set_share(share);
  request.set_verification(verification);
  return unary(request, &Stub::VerifyJob);
}

v1::Job Session::pin(const std::string& job) {
  v1::PinJobRequest request;
  request.set_job(job);
  return unary(request, &Stub::PinJob);
}

v1::Job Session::unpin(const std::string& job) {
  v1::UnpinJobRequest request;
  request.set_job(job);
  return unary(request, &Stub::UnpinJob);
}

std::string Session::delete_job(const std::string& job) {
  v1::DeleteJobRequest request;
  request.set_job(job);
  return unary(request, &Stub::DeleteJob).id();
}

v1::ServerInfo Session::server_info() {
  return unary(v1::GetServerInfoRequest(), &Stub::GetServerInfo);
}

void Session::require_health() {
  if (!stub_) connect();
  bool serving = false;
  if (const grpc::Status status = check_health(channel_, kHealthDeadline, serving); !status.ok()) {
    fail(status, ExitCode::kNotAllowed);
  }
  if (!serving) throw ClientError(ExitCode::kUnreachable, "the server at " + target_ + " is not serving");
}

v1::ArtifactHeader Session::fetch(const v1::FetchArtifactRequest& request,
                                  const std::function<std::unique_ptr<ArtifactSink>()>& make_sink) {
  v1::ArtifactHeader header;
  run(
      [&](Stub& stub) {
        const std::unique_ptr<ArtifactSink> sink = make_sink();
        return fetch_once(stub, request, *sink, header, policy_);
      },
      ExitCode::kNotFound);
  return header;
}

std::string Session::fetch_bytes(const v1::FetchArtifactRequest& request, v1::ArtifactHeader* header) {
  std::string bytes;
  const v1::ArtifactHeader got = fetch(request, [&] { return std::make_unique<MemorySink>(bytes); });
  if (header != nullptr) *header = got;
  return bytes;
}

}  // namespace affskel::client

#include "client/connection/session.h"

#include <grpcpp/channel.h>
#include <grpcpp/create_channel.h>
#include <grpcpp/security/credentials.h>

#include <algorithm>
#include <atomic>
#include <functional>
#include <optional>
#include <stop_token>
#include <thread>
#include <utility>

#include "affskel/v1/client_service.grpc.pb.h"
#include "base/pause.h"
#include "client/connection/call_errors.h"
#include "client/connection/embedded_server.h"
#include "client/connection/health.h"
#include "client/connection/transfers.h"
#include "wire/address.h"
#include "wire/limits.h"

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

// Whether the server is away or closing.  A closing server cancels the calls that it no longer answers; this
// side never cancels one.
bool is_away(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::UNAVAILABLE ||
         status.error_code() == grpc::StatusCode::CANCELLED;
}

// Tells when what is done while it lives takes long.
class TellIfSlow {
 public:
  TellIfSlow(std::chrono::milliseconds silence, std::function<void()> tell)
      : thread_([silence, tell = std::move(tell)](const std::stop_token& stop) {
          base::pause(silence, stop);
          if (!stop.stop_requested()) tell();
        }) {}

 private:
  std::jthread thread_;
};

class MemorySink : public ArtifactSink {
 public:
  explicit MemorySink(std::string& bytes) : bytes_(bytes) {}
  void begin(const v1::ArtifactHeader&) override { bytes_.clear(); }
  void data(std::string_view bytes) override { bytes_.append(bytes); }
  void end() override {}

 private:
  std::string& bytes_;
};

template <typename Request>
Request about(const std::string& job) {
  Request request;
  request.set_job(job);
  return request;
}

}  // namespace

bool is_final(v1::JobState state) {
  return state == v1::JOB_STATE_DONE || state == v1::JOB_STATE_FAILED || state == v1::JOB_STATE_CANCELLED;
}

/// The connection, and how calls are repeated over it.
class Session::Link {
 public:
  using Stub = v1::ErosionService::Stub;

  Link(ServerChoice choice, Environment environment, Listener listener, RetryPolicy policy)
      : choice_(std::move(choice)),
        environment_(std::move(environment)),
        listener_(std::move(listener)),
        policy_(std::move(policy)) {}

  const RetryPolicy& policy() const { return policy_; }
  const std::string& target() const { return target_; }
  void notify(const Notice& notice) const {
    if (listener_) listener_(notice);
  }

  /// Runs `attempt` until it succeeds or fails for good.
  void run(const std::function<grpc::Status(Stub&)>& attempt, ExitCode not_yet = ExitCode::kNotAllowed);
  template <typename Request, typename Response>
  Response unary(const Request& request,
                 grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*));
  v1::Job watch(const std::string& job, const std::function<void(const v1::Job&)>& seen);
  void require_health();

 private:
  void connect();
  // One stream; OK when it ended with a final state, or broke after something had arrived.
  grpc::Status watch_once(Stub& stub, const v1::WatchJobRequest& request, v1::Job& last,
                          const std::function<void(const v1::Job&)>& seen);
  [[noreturn]] void fail(const grpc::Status& status, ExitCode not_yet) const;
  TellIfSlow tell_if_slow();
  void notify_away();
  void notify_busy(const std::string& why);

  const ServerChoice choice_;
  const Environment environment_;
  const Listener listener_;
  const RetryPolicy policy_;
  std::string target_;
  std::shared_ptr<grpc::Channel> channel_;  // of stub_
  std::unique_ptr<Stub> stub_;
  bool proven_ = false;     // the server answered at least once
  bool told_away_ = false;  // that it went away; until it is back
  std::atomic<bool> told_slow_ = false;
};

Session::Session(ServerChoice choice, Environment environment, Listener listener, RetryPolicy policy)
    : link_(std::make_unique<Link>(std::move(choice), std::move(environment), std::move(listener),
                                   std::move(policy))) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;

void Session::notify(const Notice& notice) const {
  link_->notify(notice);
}

void Session::Link::connect() {
  wire::Address address = choice_.address;
  if (choice_.embedded) {
    const TellIfSlow slow = tell_if_slow();
    address = ensure_embedded_server(embedded_paths(environment_), {}, environment_, listener_);
  }
  target_ = address.target();
  channel_ = channel_to(address, choice_.access);
  stub_ = v1::ErosionService::NewStub(channel_);
}

void Session::Link::run(const std::function<grpc::Status(Stub&)>& attempt, ExitCode not_yet) {
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
      notify_busy(status.error_message());
    } else {
      notify_away();
    }
    stub_.reset();
    base::pause(pause, policy_.stop);
    pause = std::min(2 * pause, policy_.longest_pause);
  }
  proven_ = true;
  told_away_ = false;
}

void Session::Link::fail(const grpc::Status& status, ExitCode not_yet) const {
  const ClientError error = error_from_status(status, target_, not_yet);
  if (!is_away(status) || choice_.embedded) throw error;
  throw ClientError(error.exit_code(), std::string(error.what()) + " (address from " + choice_.origin + ")");
}

TellIfSlow Session::Link::tell_if_slow() {
  return {policy_.silence, [this] {
            if (!told_slow_.exchange(true)) notify(note("NO_ANSWER_YET", "the server has not answered yet"));
          }};
}

void Session::Link::notify_away() {
  if (proven_ && !told_away_) notify(note("SERVER_AWAY", "the server went away; trying to reach it again"));
  told_away_ = true;
}

void Session::Link::notify_busy(const std::string& why) {
  if (!told_away_) notify(note("SERVER_BUSY", "the server cannot answer now, trying again: " + why));
  told_away_ = true;
}

template <typename Request, typename Response>
Response Session::Link::unary(const Request& request,
                              grpc::Status (Stub::*method)(grpc::ClientContext*, const Request&, Response*)) {
  Response response;
  run([&](Stub& stub) {
    grpc::ClientContext context;
    const CancelOnStop cancel(context, policy_.stop);
    const TellIfSlow slow = tell_if_slow();
    context.set_deadline(std::chrono::system_clock::now() + policy_.call_deadline);
    response.Clear();
    return (stub.*method)(&context, request, &response);
  });
  return response;
}

v1::Job Session::submit(const v1::SubmitJobHeader& header, const GivenMeshes& meshes, bool& existed) {
  v1::SubmitJobResponse response;
  link_->run([&](Link::Stub& stub) {
    grpc::ClientContext context;
    const CancelOnStop cancel(context, link_->policy().stop);
    return submit_once(stub, context, header, meshes, response);
  });
  existed = response.existed();
  return response.job();
}

v1::Job Session::get_job(const std::string& job) {
  return link_->unary(about<v1::GetJobRequest>(job), &Link::Stub::GetJob);
}

v1::ListJobEventsResponse Session::job_events(const std::string& job) {
  return link_->unary(about<v1::ListJobEventsRequest>(job), &Link::Stub::ListJobEvents);
}

std::vector<v1::Job> Session::list_jobs(v1::ListJobsRequest request, std::size_t limit) {
  std::vector<v1::Job> jobs;
  while (jobs.size() < limit) {
    request.set_limit(
        static_cast<std::uint32_t>(std::min<std::size_t>(limit - jobs.size(), wire::kMaxListedJobs)));
    const v1::ListJobsResponse response = link_->unary(request, &Link::Stub::ListJobs);
    jobs.insert(jobs.end(), response.jobs().begin(), response.jobs().end());
    if (response.next_page_token().empty()) break;
    request.set_page_token(response.next_page_token());
  }
  return jobs;
}

grpc::Status Session::Link::watch_once(Stub& stub, const v1::WatchJobRequest& request, v1::Job& last,
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

v1::Job Session::Link::watch(const std::string& job, const std::function<void(const v1::Job&)>& seen) {
  auto request = about<v1::WatchJobRequest>(job);
  v1::Job last;
  while (true) {
    run([&](Stub& stub) { return watch_once(stub, request, last, seen); });
    if (is_final(last.state())) return last;
    request.set_job(last.id());  // "@last" may mean another job by now
    notify_away();
    stub_.reset();
    base::pause(policy_.first_pause, policy_.stop);
  }
}

v1::Job Session::cancel(const std::string& job) {
  return link_->unary(about<v1::CancelJobRequest>(job), &Link::Stub::CancelJob);
}

v1::Job Session::resume(const std::string& job, const std::string& distrust) {
  auto request = about<v1::ResumeJobRequest>(job);
  request.set_distrust(distrust);
  return link_->unary(request, &Link::Stub::ResumeJob);
}

v1::Verification Session::verify(const std::string& job, double share, std::uint64_t verification) {
  auto request = about<v1::VerifyJobRequest>(job);
  request.set_share(share);
  request.set_verification(verification);
  return link_->unary(request, &Link::Stub::VerifyJob);
}

v1::Job Session::pin(const std::string& job) {
  return link_->unary(about<v1::PinJobRequest>(job), &Link::Stub::PinJob);
}

v1::Job Session::unpin(const std::string& job) {
  return link_->unary(about<v1::UnpinJobRequest>(job), &Link::Stub::UnpinJob);
}

v1::Job Session::set_stance(const std::string& job, const v1::Stance& stance) {
  auto request = about<v1::SetStanceRequest>(job);
  if (stance.up() != v1::AXIS_DIRECTION_UNSPECIFIED) *request.mutable_stance() = stance;
  return link_->unary(request, &Link::Stub::SetStance);
}

std::string Session::delete_job(const std::string& job) {
  return link_->unary(about<v1::DeleteJobRequest>(job), &Link::Stub::DeleteJob).id();
}

v1::ServerInfo Session::server_info() {
  return link_->unary(v1::GetServerInfoRequest(), &Link::Stub::GetServerInfo);
}

std::string Session::address() const {
  return link_->target();
}

void Session::Link::require_health() {
  if (!stub_) connect();
  bool serving = false;
  if (const grpc::Status status = check_health(channel_, kHealthDeadline, serving); !status.ok()) {
    fail(status, ExitCode::kNotAllowed);
  }
  if (!serving) throw ClientError(ExitCode::kUnreachable, "the server at " + target_ + " is not serving");
}

void Session::require_health() {
  link_->require_health();
}

v1::Job Session::watch(const std::string& job, const std::function<void(const v1::Job&)>& seen) {
  return link_->watch(job, seen);
}

v1::ArtifactHeader Session::fetch(const v1::FetchArtifactRequest& request,
                                  const std::function<std::unique_ptr<ArtifactSink>()>& make_sink) {
  v1::ArtifactHeader header;
  link_->run(
      [&](Link::Stub& stub) {
        grpc::ClientContext context;
        const CancelOnStop cancel(context, link_->policy().stop);
        if (const auto patience = link_->policy().artifact_patience; patience.count() > 0)
          context.set_deadline(std::chrono::system_clock::now() + patience);
        return fetch_once(stub, context, request, *make_sink(), header);
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

#include "link/server_link.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <random>

#include "base/logfmt.h"
#include "base/pause.h"
#include "link/retry_policy.h"
#include "wire/address.h"
#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::worker {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto kLookAtStop = std::chrono::milliseconds(100);
// A connection that no longer carries anything, though it was not closed, is replaced after the sum.
constexpr int kKeepaliveMs = 10000;
constexpr int kKeepaliveTimeoutMs = 10000;

std::shared_ptr<grpc::Channel> connect(const ServerLinkOptions& options) {
  const wire::Address address = wire::parse_address(options.address);
  grpc::ChannelArguments arguments;
  // A proxy elsewhere cannot reach this machine's own addresses.
  if (address.is_local()) arguments.SetInt(GRPC_ARG_ENABLE_HTTP_PROXY, 0);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  arguments.SetInt(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  arguments.SetInt(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  // The answers to reports: bounds, and little else.
  arguments.SetMaxReceiveMessageSize(int{wire::kMaxBoundsBytes} + (1 << 20));
  // Come back quickly after a server restart.  The second is how long one attempt may take.
  arguments.SetInt(GRPC_ARG_INITIAL_RECONNECT_BACKOFF_MS, 50);
  arguments.SetInt(GRPC_ARG_MIN_RECONNECT_BACKOFF_MS, 2000);
  arguments.SetInt(GRPC_ARG_MAX_RECONNECT_BACKOFF_MS, 500);
  return wire::make_channel(address, options.access, arguments);
}

}  // namespace

ServerLink::ServerLink(const ServerLinkOptions& options, std::stop_token stop)
    : channel_(connect(options)),
      stub_(v1::WorkerService::NewStub(channel_)),
      options_(options),
      stop_(std::move(stop)),
      seed_(std::random_device()()) {}

// A worker that waits for its server says so, once; without it a wrong address looks like having no work.
void ServerLink::note_answer(const grpc::Status& status) {
  const bool away = status.error_code() == grpc::StatusCode::UNAVAILABLE ||
                    status.error_code() == grpc::StatusCode::CANCELLED;
  if (away == away_.exchange(away)) return;
  if (away) {
    std::string message = status.error_message();
    // So ends a connection in the clear to a server that speaks TLS.
    if (!options_.address.starts_with("unix:") && options_.access.tls_ca.empty() &&
        message.find("Socket closed") != std::string::npos)
      message += "; if it speaks TLS, name who signed its certificate: --tls-ca";
    spdlog::warn(base::logfmt("server_away", {{"server", options_.address}, {"message", message}}));
  } else {
    spdlog::info(base::logfmt("server_back", {{"server", options_.address}}));
  }
}

// gRPC's connections make progress while a thread waits for them: between two calls none would but its
// backup poller, every five seconds.
void ServerLink::rest(std::chrono::milliseconds pause, const std::stop_token& stop) {
  if (channel_->GetState(true) == GRPC_CHANNEL_READY) return base::pause(pause, stop);
  const auto end = std::chrono::system_clock::now() + pause;
  while (!stop.stop_requested() && std::chrono::system_clock::now() < end) {
    if (channel_->WaitForConnected(std::min(end, std::chrono::system_clock::now() + kLookAtStop))) return;
  }
}

/// What the tries of a call tell each other.
struct ServerLink::Course {
  std::uint64_t bytes = 0;                 // that the call moves, once it is known: it has time for them
  Clock::time_point moved = Clock::now();  // when the server last took or sent some
};

template <class Call>
void ServerLink::with_retries(const char* what, Call call, const std::stop_token& task, std::uint64_t bytes) {
  const Clock::time_point begun = Clock::now();
  const auto since_begun = [begun](Clock::time_point time) {
    return std::chrono::duration_cast<RetryPolicy::Duration>(time - begun);
  };
  RetryPolicy policy(options_.patience, seed_++);
  Course course{bytes};
  for (;;) {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + call_timeout(course.bytes));
    const grpc::Status status = call(context, course);
    note_answer(status);
    if (status.ok()) return;
    std::string message = what;
    message.append(": ").append(status.error_message());
    policy.heard(since_begun(course.moved));
    const RetryPolicy::Decision decision = policy.after(status.error_code(), since_begun(Clock::now()),
                                                        channel_->GetState(false) == GRPC_CHANNEL_READY);
    switch (decision.verdict) {
      case RetryPolicy::Verdict::kAgain:
        break;
      case RetryPolicy::Verdict::kLeaseLost:
        if (status.error_code() == grpc::StatusCode::DATA_LOSS) throw InputDamaged(message);
        throw LeaseLost(message);
      case RetryPolicy::Verdict::kFailed:
        if (status.error_code() == grpc::StatusCode::UNAUTHENTICATED ||
            status.error_code() == grpc::StatusCode::PERMISSION_DENIED) {
          throw NotAllowed(message);
        }
        throw std::runtime_error(message);
      case RetryPolicy::Verdict::kServerGone:
        throw ServerGone(message);
    }
    rest(decision.pause, task.stop_possible() ? task : stop_);
    if (task.stop_requested()) throw Interrupted(message);
    if (stop_.stop_requested()) throw ServerGone(message);
  }
}

namespace {

/// A worker that asks for work has no lease that could be lost: an answer about stored bytes is then the
/// trouble of a server whose disk cannot be read just now.
grpc::Status without_lease(const grpc::Status& status) {
  switch (status.error_code()) {
    case grpc::StatusCode::DATA_LOSS:
    case grpc::StatusCode::ABORTED:
    case grpc::StatusCode::NOT_FOUND:
      return {grpc::StatusCode::UNAVAILABLE, status.error_message()};
    default:
      return status;
  }
}

}  // namespace

std::optional<v1::Lease> ServerLink::lease(const v1::LeaseTaskRequest& request) {
  v1::LeaseTaskResponse response;
  bool stopped = false;
  with_retries("asking for work", [&](grpc::ClientContext& context, Course&) {
    // Prompt at SIGTERM: the server then takes back a lease whose reply it cannot deliver.
    const std::stop_callback cancel(stop_, [&context] { context.TryCancel(); });
    const grpc::Status status = stub_->LeaseTask(&context, request, &response);
    stopped = stop_.stop_requested() && status.error_code() == grpc::StatusCode::CANCELLED;
    return stopped ? grpc::Status::OK : without_lease(status);
  });
  if (stopped || !response.has_lease()) return std::nullopt;
  return response.lease();
}

std::string ServerLink::fetch(const std::string& token, v1::ArtifactKind kind, const std::stop_token& stop,
                              const std::optional<std::uint32_t>& known_round) {
  v1::FetchInputRequest request;
  if (known_round) request.set_known_round(*known_round);
  request.set_token(token);
  request.set_kind(kind);
  std::string bytes;
  with_retries(
      "fetching an input",
      [&](grpc::ClientContext& context, Course& course) {
        const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
        const grpc::Status status = fetch_once(request, context, course, bytes);
        if (stop.stop_requested()) throw Interrupted("fetching an input was ended early");
        return status;
      },
      stop);
  return bytes;
}

grpc::Status ServerLink::fetch_once(const v1::FetchInputRequest& request, grpc::ClientContext& context,
                                    Course& course, std::string& bytes) {
  bytes.clear();
  v1::ArtifactHeader header;
  v1::FetchArtifactResponse part;
  const auto reader = stub_->FetchInput(&context, request);
  while (reader->Read(&part)) {
    course.moved = Clock::now();
    if (part.has_header()) {
      header = part.header();
      course.bytes = header.bytes();
      bytes.reserve(header.bytes());
    } else {
      bytes += part.data();
    }
  }
  const grpc::Status status = reader->Finish();
  if (status.ok() && (bytes.size() != header.bytes() || wire::sha256_hex(bytes) != header.sha256())) {
    return grpc::Status(grpc::StatusCode::INTERNAL, "the bytes that arrived are not those that were sent");
  }
  return status;
}

v1::ReportResponse ServerLink::report(const v1::ReportErosionHeader& header,
                                      const std::vector<v1::ReportErosionRequest>& records) {
  v1::ReportErosionRequest first;
  *first.mutable_header() = header;
  // A stream that broke looks like one that ended: the count tells them apart.
  std::uint64_t count = 0, bytes = 0;
  for (const v1::ReportErosionRequest& message : records) {
    bytes += message.ByteSizeLong();
    count += static_cast<std::uint64_t>(message.records().point_size() + message.refined().point_size());
  }
  first.mutable_header()->set_records(count);
  first.mutable_header()->set_bounds_for(options_.worker);
  first.mutable_header()->set_bounds_bytes(wire::kMaxBoundsBytes);
  v1::ReportResponse response;
  const auto send = [&](grpc::ClientContext& context, Course& course) {
    response.Clear();
    const auto writer = stub_->ReportErosion(&context, &response);
    bool open = writer->Write(first);
    for (auto message = records.begin(); open && message != records.end(); ++message) {
      course.moved = Clock::now();
      open = writer->Write(*message);
    }
    writer->WritesDone();
    return writer->Finish();
  };
  with_retries("reporting", send, {}, bytes);
  return response;
}

v1::ReportResponse ServerLink::complete(v1::CompleteTaskHeader header, std::string_view data) {
  header.set_bytes(data.size());
  header.set_sha256(wire::sha256_hex(data));
  v1::ReportResponse response;
  const auto send = [&](grpc::ClientContext& context, Course& course) {
    response.Clear();
    const auto writer = stub_->CompleteTask(&context, &response);
    v1::CompleteTaskRequest message;
    *message.mutable_header() = header;
    bool open = writer->Write(message);
    for (std::size_t from = 0; open && from < data.size(); from += wire::kChunkBytes) {
      course.moved = Clock::now();
      message.set_data(std::string(data.substr(from, wire::kChunkBytes)));
      open = writer->Write(message);
    }
    writer->WritesDone();
    return writer->Finish();
  };
  with_retries("handing in a result", send, {}, data.size());
  return response;
}

v1::ReportResponse ServerLink::renew(const std::string& token) {
  v1::RenewLeaseRequest request;
  request.set_token(token);
  v1::ReportResponse response;
  with_retries("renewing a lease", [&](grpc::ClientContext& context, Course&) {
    return stub_->RenewLease(&context, request, &response);
  });
  return response;
}

void ServerLink::fail(const v1::FailTaskRequest& request) {
  v1::ReportResponse response;
  with_retries("reporting a failure", [&](grpc::ClientContext& context, Course&) {
    return stub_->FailTask(&context, request, &response);
  });
}

void ServerLink::give_back(const std::string& token) {
  grpc::ClientContext context;
  context.set_wait_for_ready(true);  // it may be about to start again
  context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(2));
  v1::ReturnLeaseRequest request;
  request.set_token(token);
  v1::ReportResponse response;
  static_cast<void>(stub_->ReturnLease(&context, request, &response));
}

}  // namespace affskel::worker

#include "services/server.h"

#include <grpc/grpc.h>
#include <grpcpp/ext/proto_server_reflection_plugin.h>
#include <grpcpp/health_check_service_interface.h>
#include <grpcpp/resource_quota.h>
#include <grpcpp/server_posix.h>
#include <malloc.h>
#include <signal.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <stdexcept>
#include <system_error>

#include "base/end_limit.h"
#include "base/logfmt.h"
#include "base/mutex.h"
#include "calls/status.h"
#include "database/database_file.h"
#include "services/figures.h"
#include "traffic/listen.h"
#include "traffic/tls.h"
#include "wire/channel.h"
#include "wire/identity.h"

namespace affskel::server {
namespace {

// The largest message of the contract is a piece of data of 1 MiB and its framing.
constexpr int kMaxReceiveBytes = 4 << 20;
// A job with many finished ranges and notes, or a long list of jobs.
constexpr int kMaxSendBytes = 64 << 20;

// Reflection alone still takes a thread per call: of these there are no more, and further calls are refused.
constexpr int kReflectionThreads = 8;

// A peer that does not even answer a ping, stopped or cut off, is given up after the sum of these.
constexpr int kKeepaliveMs = 30000;
constexpr int kKeepaliveTimeoutMs = 20000;
// Workers ask whether a connection still lives, see worker/link/server_link.cc.
constexpr int kMinPingPauseMs = 5000;

// Between looks at calls that are too slow.
constexpr std::chrono::milliseconds kTick{200};

// A server that closes waits until the last of them has ended.
constexpr std::chrono::milliseconds kLookAtCalls{5};

// Between looks at what the allocator holds, and what it may hold unused: giving it back takes milliseconds.
constexpr std::chrono::seconds kTrimPause{10};
constexpr std::size_t kMaxUnusedBytes = std::size_t{32} << 20;

// gRPC waits for each connection to acknowledge the end, which an idle peer may do seconds later.
constexpr std::chrono::milliseconds kGoodbye{100};

/// Room for a mesh and a source of the greatest size beside what is kept for workers' results.
std::uint64_t upload_bytes(const ServerOptions& options) {
  return std::max(options.upload_bytes, options.store.max_mesh_bytes / 3 * 8 + 8);
}

/// What gRPC itself is told to bound.
void set_limits(grpc::ServerBuilder& builder, const CallLimits& limits) {
  builder.SetMaxReceiveMessageSize(kMaxReceiveBytes);
  builder.SetMaxSendMessageSize(kMaxSendBytes);
  // gRPC 1.51 unpacks a message before it looks at its length: 4 MB become 4 GB.
  for (const auto algorithm : {GRPC_COMPRESS_DEFLATE, GRPC_COMPRESS_GZIP})
    builder.SetCompressionAlgorithmSupportStatus(algorithm, false);
  builder.AddChannelArgument(GRPC_ARG_MAX_CONNECTION_IDLE_MS, static_cast<int>(limits.idle.count()));
  builder.AddChannelArgument(GRPC_ARG_MAX_CONCURRENT_STREAMS, limits.streams);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIME_MS, kKeepaliveMs);
  builder.AddChannelArgument(GRPC_ARG_KEEPALIVE_TIMEOUT_MS, kKeepaliveTimeoutMs);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MAX_PINGS_WITHOUT_DATA, 0);
  builder.AddChannelArgument(GRPC_ARG_HTTP2_MIN_RECV_PING_INTERVAL_WITHOUT_DATA_MS, kMinPingPauseMs);
  builder.AddChannelArgument(GRPC_ARG_SERVER_HANDSHAKE_TIMEOUT_MS, static_cast<int>(limits.idle.count()));
  grpc::ResourceQuota quota("affskel-server");
  quota.Resize(static_cast<std::size_t>(limits.grpc_bytes));
  quota.SetMaxThreads(kReflectionThreads);
  builder.SetResourceQuota(quota);
  using Option = grpc::ServerBuilder::SyncServerOption;
  builder.SetSyncServerOption(Option::NUM_CQS, 1);
  builder.SetSyncServerOption(Option::MIN_POLLERS, 1);
  builder.SetSyncServerOption(Option::MAX_POLLERS, 2);
}

RelayOptions relay_options(const CallLimits& limits) {
  RelayOptions options;
  options.first = limits.idle;
  options.stall = limits.sending.window;
  options.frames.calls = static_cast<std::size_t>(limits.streams);
  return options;
}

/// Keeps the gRPC library initialised until the process ends.  Its last shutdown joins a thread that may
/// sit in a poll of 10 s (the backup poller of a connection that had to wait for its peer), which would
/// hold up every exit.
void hold_grpc() {
  static const bool held = [] {
    grpc_init();
    return true;
  }();
  static_cast<void>(held);
}

/// Leases of a predecessor's workers that end with it, or a little later, need not wait for their deadline.
void release_dead_workers(Store& store) {
  for (const Store::Holder& holder : store.supervised_holders()) {
    const bool dead = kill(static_cast<pid_t>(holder.pid), 0) != 0 && errno == ESRCH;
    if (holder.host == wire::host_name() && dead) store.release_worker(holder.host, holder.pid);
  }
}

/// What a crowd has taken goes back to the system when it has left.
void give_memory_back() {
  if (mallinfo2().fordblks > kMaxUnusedBytes) malloc_trim(0);
}

}  // namespace

void require_protected(const ServerOptions& options) {
  if (options.metrics) require_local_metrics(*options.metrics, options.insecure);
  // What cannot be looked at is told when it is opened.
  std::error_code hidden;
  const bool may_have_token = std::filesystem::exists(database_file(options.data_dir), hidden) || hidden;
  require_protection(options.listen, {!options.tls.certificate.empty(), may_have_token, options.insecure});
}

Server::Server(const ServerOptions& options)
    : registry_(clock_, options.store.lease_ms), room_(options.limits, upload_bytes(options)) {
  try {
    start(options);
  } catch (...) {
    base::limit_end();
    stop(std::chrono::milliseconds(0));
    throw;
  }
}

void Server::start(const ServerOptions& options) {
  hold_grpc();
  require_protected(options);
  prepare_addresses(options.listen);
  store_ =
      std::make_unique<Store>(database_file(options.data_dir), options.store, clock_, &hub_, &room_.metrics);
  release_dead_workers(*store_);
  if (!options.tls.certificate.empty()) wire::forbid_core_dumps();
  keep_secrets();
  require_protection(options.listen,
                     {!options.tls.certificate.empty(), store_->has_valid_token(), options.insecure});
  room_.gate.emplace(*store_,
                     GateOptions{!options.tls.client_ca.empty(), [this] { return clock_.wall_ms(); }});
  jobs_ = std::make_unique<JobView>(*store_, registry_);
  queue_ = std::make_unique<LeaseQueue>(*store_, registry_, bounds_, room_);
  worker_service_ = std::make_unique<WorkerServiceImpl>(room_, *store_, registry_, *queue_, bounds_);
  erosion_service_ = std::make_unique<ErosionServiceImpl>(
      room_, *store_, registry_, *jobs_, hub_,
      ErosionServiceImpl::Facts{options.data_dir, static_cast<std::uint64_t>(clock_.wall_ms())});
  hub_.start([this](const std::string& id) { return jobs_->load(id); }, [this] { queue_->on_work(); });
  if (options.metrics) serve_metrics(*options.metrics, options.limits.scrapes);
  serve(options);
  maintenance_ = std::thread([this] { maintain(); });
  ticker_ = std::thread([this] { tick(); });
}

Server::~Server() {
  base::limit_end();  // for what gRPC lost when threads or memory were short it waits without end
  stop();
}

void Server::serve(const ServerOptions& options) {
  listener_ = std::make_unique<Listener>(options.listen, options.socket_mode);
  grpc::EnableDefaultHealthCheckService(true);
  grpc::reflection::InitProtoReflectionServerBuilderPlugin();
  grpc::ServerBuilder builder;
  set_limits(builder, options.limits);
  builder.RegisterService(worker_service_.get());
  builder.RegisterService(erosion_service_.get());
  if (!options.tls.certificate.empty()) tls_files_.emplace(options.tls, speak_http2);
  relay_ = std::make_unique<Relay>(relay_options(options.limits));
  grpc_ = builder.BuildAndStart();
  if (grpc_ == nullptr) throw std::runtime_error("cannot start serving (see the log above)");
  for (const char* service :
       {v1::ErosionService::service_full_name(), v1::WorkerService::service_full_name()}) {
    grpc_->GetHealthCheckService()->SetServingStatus(service, true);
  }
  listener_->start([this](int connection, const PeerIdentity& peer) { return take(connection, peer); });
}

std::optional<wire::Address> Server::metrics_address() const {
  return endpoint_ == nullptr ? std::nullopt : std::optional(endpoint_->address());
}

/// Each kind of figures from where it is: what has happened since the start, and what is there now.
void Server::serve_metrics(const wire::Address& address, std::size_t scrapes) {
  const auto started_ms = static_cast<std::uint64_t>(clock_.wall_ms());
  const auto collect = [this, started_ms] {
    std::vector<prometheus::MetricFamily> families = room_.metrics.collect();
    for (prometheus::MetricFamily& family : figures_of(*store_, registry_, room_, started_ms)) {
      families.push_back(std::move(family));
    }
    return families;
  };
  endpoint_ =
      std::make_unique<MetricsEndpoint>(address, EndpointSources{collect, [this] { return trouble(); }},
                                        EndpointOptions{.connections = scrapes});
}

/// Reads the database, as any call would.
std::string Server::trouble() {
  if (draining_) return "the server is shutting down";
  if (store_->lost()) return "the database was removed or replaced";
  store_->counts();
  return {};
}

bool Server::take(int connection, const PeerIdentity& peer) {
  const bool is_tls = tls_files_ && !peer.uid;
  const std::shared_ptr<RelayLine> line =
      relay_->take(connection, peer.name, is_tls ? tls_files_->context() : nullptr);
  const std::optional<std::uint64_t> number = room_.connections.admit(peer, line);
  if (!number) return false;
  const auto begun = [this, number = *number](int socket, bool has_certificate) {
    room_.connections.hand_over(number, socket, has_certificate);
    grpc::AddInsecureChannelFromFd(grpc_.get(), socket);
  };
  const auto refused = [this, peer](const std::string& why) { log_refused(peer, why); };
  line->start({begun, refused, [this, number = *number] { room_.connections.forget(number); }});
  return true;
}

void Server::log_refused(const PeerIdentity& peer, const std::string& why) {
  const auto number = refused_.happened(std::chrono::steady_clock::now());
  if (!number) return;
  spdlog::warn(
      base::logfmt("connection_ended", {{"number", *number}, {"peer", peer.name}, {"message", why}}));
}

/// From the first token on, nothing of this process goes into a core dump.
void Server::keep_secrets() {
  if (secretive_ || !store_->has_tokens()) return;
  wire::forbid_core_dumps();
  secretive_ = true;
}

/// Apart from the store's maintenance, which may have to wait for the disk.
void Server::tick() {
  base::MutexLock lock(mutex_);
  while (!stopped_.wait_for(lock, kTick, [this] {
    mutex_.assert_held();
    return closed_;
  })) {
    lock.unlock();
    guarded([this] {
      room_.tick();
      relay_->tick();
    });
    lock.lock();
  }
}

void Server::maintain() {
  using Steady = std::chrono::steady_clock;
  // Often enough that an expired lease waits a fraction of its own length.
  const auto pause =
      std::chrono::milliseconds(std::clamp<std::int64_t>(store_->options().lease_ms / 10, 20, 500));
  Steady::time_point due = Steady::now() + pause;
  Steady::duration rest = pause;
  Steady::time_point trimmed = Steady::now();
  base::MutexLock lock(mutex_);
  while (!stopped_.wait_for(lock, rest, [this] {
    mutex_.assert_held();
    return stopping_;
  })) {
    lock.unlock();
    if (Steady::now() >= due) {
      look_after_calls();
      due = Steady::now() + pause;
    }
    // What is left of deleted jobs may be much: others get the store between two steps for as long as one
    // took, and leases, tokens and certificates are looked after all the same.
    const Steady::time_point begin = Steady::now();
    tidy();
    const Steady::time_point now = Steady::now();
    if (now - trimmed >= kTrimPause) {
      give_memory_back();
      trimmed = now;
    }
    rest = tidying_ ? now - begin : std::max(due - now, Steady::duration::zero());
    lock.lock();
  }
}

void Server::look_after_calls() {
  guarded([this] {
    release_dead_workers(*store_);
    store_->expire_leases();
  });
  erosion_service_->retry_withdrawals();
  guarded([this] { room_.tick_gate(); });
  guarded([this] { keep_secrets(); });
  if (!tls_files_) return;
  try {
    tls_files_->look();
  } catch (const std::exception& error) {
    spdlog::warn(base::logfmt("tls_files_not_used", {{"message", error.what()}}));
  }
}

/// One step.
void Server::tidy() {
  bool more = false;
  guarded([&] {
    const bool retained = store_->retain();
    more = store_->tidy() || retained;
  });
  tidying_ = more;
}

std::chrono::steady_clock::duration Server::idle_time() {
  const Store::Counts counts = store_->counts();
  if (counts.queued > 0 || counts.running > 0 || counts.requests > 0 || tidying_) {
    room_.activity.touch();
    return std::chrono::steady_clock::duration::zero();
  }
  return room_.activity.idle_time();
}

void Server::drain() {
  draining_ = true;
  if (grpc_ != nullptr && grpc_->GetHealthCheckService() != nullptr) {
    grpc_->GetHealthCheckService()->SetServingStatus(false);
  }
  if (queue_ != nullptr) queue_->stop();
  if (erosion_service_ != nullptr) erosion_service_->close();
  room_.close();
}

void Server::await_calls(std::chrono::milliseconds grace) const {
  const auto end = std::chrono::steady_clock::now() + grace;
  while (room_.connections.calls() > 0 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(kLookAtCalls);
  }
}

void Server::stop(std::chrono::milliseconds grace) {
  {
    const base::MutexLock lock(mutex_);
    stopping_ = true;
  }
  stopped_.notify_all();
  if (maintenance_.joinable()) maintenance_.join();
  drain();
  endpoint_.reset();
  if (listener_ != nullptr) listener_->stop();
  if (grpc_ != nullptr) {
    await_calls(grace);
    grpc_->Shutdown(std::chrono::system_clock::now() + kGoodbye);
    grpc_->Wait();
  }
  if (relay_ != nullptr) relay_->stop();
  room_.stop();
  {
    const base::MutexLock lock(mutex_);
    closed_ = true;
  }
  stopped_.notify_all();
  if (ticker_.joinable()) ticker_.join();
  hub_.stop();
}

}  // namespace affskel::server

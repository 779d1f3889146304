#pragma once

#include <grpcpp/grpcpp.h>
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "base/mutex.h"
#include "calls/call_room.h"
#include "calls/limits.h"
#include "metrics/endpoint.h"
#include "net/tls_files.h"
#include "scheduling/lease_queue.h"
#include "scheduling/worker_registry.h"
#include "services/erosion_service.h"
#include "services/event_hub.h"
#include "services/job_view.h"
#include "services/worker_service.h"
#include "store/clock.h"
#include "store/store.h"
#include "traffic/listener.h"
#include "traffic/rare_log.h"
#include "traffic/relay.h"
#include "wire/address.h"

namespace affskel::server {

struct ServerOptions {
  std::string data_dir;  ///< must exist; holds affskel.db
  std::vector<wire::Address> listen;
  mode_t socket_mode = 0600;  ///< of Unix sockets: the users that may connect
  net::TlsOptions tls;        ///< of all TCP addresses
  bool insecure = false;      ///< addresses that other machines reach need neither TLS nor tokens
  /// Where metrics are told to every peer; other machines only with `insecure`.
  std::optional<wire::Address> metrics;
  StoreOptions store;
  /// Uploads in memory at once; a mesh and a source of the greatest size always find room.
  std::uint64_t upload_bytes = std::uint64_t{2} << 30;
  CallLimits limits = limits_for(open_files_limit());
};

/// Before anything is made, lest a start that is refused leave a directory with a database.
/// @throws std::runtime_error naming an address that other machines reach and what it lacks.
void require_protected(const ServerOptions& options);

/// A serving server: the store, both services and the maintenance of leases, without signals and
/// processes.  Works until stopped or destroyed.
///
/// No call holds a thread while it waits for its peer: gRPC's own threads move messages, and what touches the
/// store runs in the executors of the CallRoom.
class Server {
 public:
  /// Opens the database and starts serving.
  /// @throws std::runtime_error (StoreError, SqliteError) naming file or address and cause.
  explicit Server(const ServerOptions& options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  /// Where it listens, with the ports actually bound.
  const std::vector<wire::Address>& addresses() const { return listener_->addresses(); }

  /// Where it tells its metrics, if it does, with the port actually bound.
  std::optional<wire::Address> metrics_address() const;

  Store& store() { return *store_; }
  WorkerRegistry& registry() { return registry_; }
  const CallRoom& room() const { return room_; }

  /// Time without client calls, without active jobs, without requests for artefacts, and without anything of
  /// deleted jobs going.
  std::chrono::steady_clock::duration idle_time();

  /// Ends the calls that wait with UNAVAILABLE, lets no stream of a client begin and leases nothing more;
  /// what is under way goes on, and reports are still taken.
  void drain();

  /// Drains, lets running calls end within `grace`, cancels the others, and closes.
  void stop(std::chrono::milliseconds grace = std::chrono::milliseconds(2000));

 private:
  void start(const ServerOptions& options);
  void serve(const ServerOptions& options);
  void serve_metrics(const wire::Address& address, std::size_t scrapes);
  std::string trouble();
  void keep_secrets();
  void maintain();
  void look_after_calls();
  void tick();
  void tidy();
  bool take(int connection, const PeerIdentity& peer);
  void log_refused(const PeerIdentity& peer, const std::string& why);
  void await_calls(std::chrono::milliseconds grace) const;

  SystemClock clock_;
  EventHub hub_;
  WorkerRegistry registry_;
  BoundsExchange bounds_;
  CallRoom room_;
  std::unique_ptr<Store> store_;
  std::unique_ptr<JobView> jobs_;
  std::unique_ptr<LeaseQueue> queue_;
  std::unique_ptr<WorkerServiceImpl> worker_service_;
  std::unique_ptr<ErosionServiceImpl> erosion_service_;
  std::optional<net::TlsFiles> tls_files_;  // looked at by the thread that maintains
  RareLog refused_{std::chrono::seconds(10)};
  std::unique_ptr<Relay> relay_;
  std::unique_ptr<grpc::Server> grpc_;
  std::unique_ptr<Listener> listener_;

  std::unique_ptr<MetricsEndpoint> endpoint_;
  std::atomic<bool> draining_ = false;

  bool secretive_ = false;  // of the thread that maintains
  std::atomic<bool> tidying_ = false;
  base::Mutex mutex_;
  std::condition_variable_any stopped_;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  bool closed_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread maintenance_;
  std::thread ticker_;
};

}  // namespace affskel::server

#pragma once

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "clock.h"
#include "rpc/activity.h"
#include "rpc/call_limit.h"
#include "rpc/erosion_service.h"
#include "rpc/event_hub.h"
#include "rpc/lease_queue.h"
#include "rpc/listener.h"
#include "rpc/upload_budget.h"
#include "rpc/worker_registry.h"
#include "rpc/worker_service.h"
#include "store/store.h"
#include "wire/address.h"

namespace affskel::server {

struct ServerOptions {
  std::string data_dir;  ///< must exist; holds affskel.db
  std::vector<wire::Address> listen;
  StoreOptions store;
  /// Uploads in memory at once; at least one mesh of the greatest size always finds room.
  std::uint64_t upload_bytes = std::uint64_t{2} << 30;
  CallLimits limits = limits_for(open_files_limit());
};

/// A serving server: the store, both services and the maintenance of leases, without signals and
/// processes.  Works until stopped or destroyed.
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

  Store& store() { return *store_; }
  WorkerRegistry& registry() { return registry_; }

  /// Time without client calls, without active jobs, without requests for artefacts, and without anything of
  /// deleted jobs going.
  std::chrono::steady_clock::duration idle_time();

  /// Ends the waiting calls and leases nothing more; reports are still taken.
  void drain();

  /// Drains, lets running calls end within `grace`, and closes.
  void stop(std::chrono::milliseconds grace = std::chrono::milliseconds(2000));

 private:
  void serve(const ServerOptions& options);
  void maintain();
  void tidy();

  SystemClock clock_;
  EventHub hub_;
  WorkerRegistry registry_;
  Activity activity_;
  UploadBudget uploads_;
  std::unique_ptr<Store> store_;
  std::unique_ptr<LeaseQueue> queue_;
  std::unique_ptr<WorkerServiceImpl> worker_service_;
  std::unique_ptr<ErosionServiceImpl> erosion_service_;
  std::unique_ptr<grpc::Server> grpc_;
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> acceptor_;
  std::unique_ptr<Listener> listener_;

  std::atomic<bool> tidying_ = false;
  std::mutex mutex_;
  std::condition_variable stopped_;
  bool stopping_ = false;
  std::thread maintenance_;
};

}  // namespace affskel::server

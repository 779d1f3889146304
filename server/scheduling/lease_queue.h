#pragma once

#include <grpcpp/grpcpp.h>

#include <condition_variable>
#include <list>
#include <memory>
#include <thread>
#include <vector>

#include "affskel/v1/worker_service.grpc.pb.h"
#include "base/mutex.h"
#include "calls/call_room.h"
#include "scheduling/bounds_exchange.h"
#include "scheduling/worker_registry.h"
#include "store/store.h"

namespace affskel::server {

/// Workers that wait for work; none of them holds a thread.  One thread leases for all of them, in the
/// order in which they came, but first for those that hold a job of which something is requested.  Thread-safe.
class LeaseQueue {
 public:
  /// @param bounds hears of who works on what field.
  LeaseQueue(Store& store, WorkerRegistry& registry, BoundsExchange& bounds, CallRoom& room);
  ~LeaseQueue();

  /// A LeaseTask call.
  grpc::ServerUnaryReactor* lease(grpc::CallbackServerContext* context, const v1::LeaseTaskRequest* request,
                                  v1::LeaseTaskResponse* response);

  /// A task became available.
  void on_work();

  /// Ends all waiting calls with UNAVAILABLE and grants nothing more.
  void stop();

 private:
  class Poll;
  using PollPtr = std::shared_ptr<Poll>;

  void run();
  void put_holders_first(std::list<PollPtr>& polls);
  void serve(std::list<PollPtr> polls);
  void serve_together(const std::vector<PollPtr>& polls);
  void end_poll(const PollPtr& poll, const grpc::Status& status);
  void hand_over(const PollPtr& poll, v1::Lease lease);
  void end_expired();
  void remove(const PollPtr& poll);

  Store& store_;
  WorkerRegistry& registry_;
  BoundsExchange& bounds_;
  CallRoom& room_;

  base::Mutex mutex_;
  std::condition_variable_any changed_;
  std::list<PollPtr> waiting_ ABSL_GUARDED_BY(mutex_);
  bool work_ ABSL_GUARDED_BY(mutex_) = false;
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::thread thread_;
};

}  // namespace affskel::server

#pragma once

#include <grpcpp/grpcpp.h>

#include <cstddef>
#include <memory>
#include <mutex>
#include <set>
#include <string>

#include "affskel/v1/client_service.grpc.pb.h"
#include "rpc/activity.h"
#include "rpc/event_hub.h"

namespace affskel::server {

/// All WatchJob streams of a server; none of them holds a thread.  Thread-safe.
class Watches {
 public:
  /// @param most streams at once; more are refused with UNAVAILABLE.
  Watches(EventHub& hub, Activity& activity, std::size_t most);

  /// Starts a stream for the job of this full id.
  grpc::ServerWriteReactor<v1::Job>* watch(const std::string& job_id);

  /// Ends all streams with UNAVAILABLE, so that their clients come back to the next server.
  void stop();

 private:
  class Stream;

  EventHub& hub_;
  Activity& activity_;
  const std::size_t most_;
  std::mutex mutex_;
  std::set<std::shared_ptr<Stream>> streams_;
  bool stopping_ = false;
};

/// A stream that ends at once with `status`.
grpc::ServerWriteReactor<v1::Job>* refused_watch(const grpc::Status& status);

}  // namespace affskel::server

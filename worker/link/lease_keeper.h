#pragma once

#include <thread>

#include "affskel/v1/worker_service.pb.h"
#include "link/server_link.h"
#include "link/task_context.h"

namespace affskel::worker {

/// Renews a lease in the background as long as it lives: while a task computes that has nothing to report,
/// and while a report takes longer to be sent than the lease lasts.  Ends by itself when the lease is lost or
/// cancelled.
class LeaseKeeper {
 public:
  /// Renews often enough to keep the lease; the next report tells when it is lost or cancelled.
  /// `link` must outlive it.
  LeaseKeeper(ServerLink& link, const v1::Lease& lease);

  /// For tasks that do not report: renews as often as others report, and tells the context when the lease is
  /// lost or cancelled.  The context must outlive it.
  LeaseKeeper(ServerLink& link, const v1::Lease& lease, TaskContext& context);

 private:
  std::jthread thread_;
};

}  // namespace affskel::worker

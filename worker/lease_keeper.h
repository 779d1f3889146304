#pragma once

#include <thread>

#include "affskel/v1/worker_service.pb.h"
#include "server_link.h"

namespace affskel::worker {

/// Renews a lease in the background as long as it lives: while a task computes that has nothing to report,
/// and while a report takes longer to be sent than the lease lasts.  Ends by itself when the lease is lost or
/// cancelled; the next report, or handing in the result, tells why.
class LeaseKeeper {
 public:
  /// `link` must outlive it.
  LeaseKeeper(ServerLink& link, const v1::Lease& lease);

 private:
  std::jthread thread_;
};

}  // namespace affskel::worker

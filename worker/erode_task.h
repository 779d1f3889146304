#pragma once

#include <stop_token>

#include "affskel/v1/worker_service.pb.h"
#include "prepared_job.h"
#include "server_link.h"

namespace affskel::worker {

/// How an erode task ended.
enum class ErodeEnd {
  kBlockDone,  ///< everything reported; the lease is over
  kStopped,    ///< stop requested: what was finished is reported, the lease is still ours
  kCancelled,  ///< the server took the task away; the engine's field holds unreported work: discard it
};

/// Computes the positions of an ERODE lease and reports about every lease.report_interval_ms() what is
/// finished and which points improved.  A report claims a direction only after all its offers are in the
/// field and before the field's changes are taken, so that what is acknowledged is complete.
/// @throws LeaseLost, ServerGone, core::CoreError; then, too, discard the engine.
ErodeEnd erode(const v1::Lease& lease, PreparedJob& job, core::Erosion& erosion, ServerLink& link,
               std::stop_token stop);

}  // namespace affskel::worker

#pragma once

#include <functional>
#include <stop_token>

#include "affskel/v1/worker_service.pb.h"
#include "job/prepared_job.h"
#include "link/last_report.h"
#include "link/server_link.h"

namespace affskel::worker {

/// How an erode task ended.
enum class ErodeEnd {
  kBlockDone,  ///< everything computed, and its last report started; the lease is over
  kStopped,    ///< stop requested: what was finished is reported, the lease is still ours
  kCancelled,  ///< the server took the task away; the engine's field holds unreported work: discard it
};

/// Computes the positions of an ERODE lease and reports about every lease.report_interval_ms() what is
/// finished and which points improved.  A report claims a direction only after all its offers are in the
/// field and before the field's changes are taken, so that what is acknowledged is complete.
///
/// `last` sends the block's last report while the next block is computed.  Points that one block improved may
/// be in a report of the other, so a block reports nothing before the last report of the block before is
/// acknowledged.
/// @param nearly_done called once, shortly before the block ends: the time to lease the next one.
/// @throws LeaseLost (also when it was the block before that lost its lease), ServerGone, core::CoreError;
///   then, too, discard the engine.
ErodeEnd erode(const v1::Lease& lease, PreparedJob& job, core::Erosion& erosion, ServerLink& link,
               std::stop_token stop, LastReport& last, const std::function<void()>& nearly_done);

}  // namespace affskel::worker

#pragma once

#include <functional>

#include "affskel/v1/worker_service.pb.h"
#include "job/prepared_job.h"
#include "link/last_report.h"
#include "link/server_link.h"
#include "link/task_context.h"

namespace affskel::worker {

/// Computes the points of a REFINE lease, in its round, and reports about every lease.report_interval_ms() which are
/// done, with what was found there, while the next ones are computed.  Fetches before what the job's refinement has not
/// heard of: the field over the set in round 0, what the rounds before found in others.
///
/// When the worker is to stop, reports what is done; the lease is still its own.
/// @param last takes the block's last report, which is sent while the next block is computed.
/// @param nearly_done called once, in another thread, while the last points are computed; ended when this returns.
/// @throws core::CoreError kCancelled when the context asks to stop; LeaseLost, ServerGone; what nearly_done throws.
void refine(const v1::Lease& lease, PreparedJob& job, unsigned threads, ServerLink& link,
            TaskContext& context, LastReport& last, const std::function<void()>& nearly_done);

}  // namespace affskel::worker

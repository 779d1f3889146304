#pragma once

#include "affskel/v1/worker_service.pb.h"
#include "job/prepared_job.h"
#include "link/server_link.h"
#include "link/task_context.h"

namespace affskel::worker {

/// Computes the points of a REFINE lease, in its round, and reports about every lease.report_interval_ms() which are
/// done, with what was found there, while the next ones are computed.  Fetches before what the job's refinement has not
/// heard of: the field over the set in round 0, what the rounds before found in others.
///
/// When the worker is to stop, reports what is done; the lease is still its own.
/// @throws core::CoreError kCancelled when the context asks to stop; LeaseLost, ServerGone.
void refine(const v1::Lease& lease, PreparedJob& job, unsigned threads, ServerLink& link,
            TaskContext& context);

}  // namespace affskel::worker

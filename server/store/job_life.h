#pragma once

#include <string>

#include "affskel/v1/types.pb.h"
#include "store/rows.h"
#include "store/tx.h"

namespace affskel::server {

/// How many of a job's directions are done; empty before it is prepared, when there are none.
std::string progress_text(const JobRow& job);

/// A job's stage ends, and the next one, which the caller sets, begins: counts how long it took.
void end_stage(Tx& tx, const std::string& job_id);

/// Fails an active job.
void fail_job(Tx& tx, const std::string& job_id, const v1::JobError& error);

/// Moves a job on as far as it can go without a worker: next stage, done, cancelled; failed, where what is stored of it
/// is damaged.  Called after every change to its tasks.
void settle_job(Tx& tx, const std::string& job_id);

/// Marks the pending blocks as done of which nothing is left.
void finish_whole_blocks(Tx& tx, const std::string& job_id);

/// Moves on the jobs that no worker will move: whose last block ended when there was no room for their fields, or that are
/// to be cancelled and lost their leases otherwise than by their workers.
void settle_waiting_jobs(Tx& tx);

}  // namespace affskel::server

#pragma once

#include <cstdint>
#include <exception>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "store/task_rows.h"
#include "store/tx.h"

namespace affskel::server {

/// The task that a calling worker holds by this token: what is still pending is leased to it again, with what
/// it has computed. A machine that was overloaded for a moment so loses nothing.  @throws StoreError kFenced
TaskRow held_task(Tx& tx, const std::string& token);
/// The same for a task that was found by its token.
TaskRow resume_if_late(Tx& tx, TaskRow task);

/// Renews the deadline.
void renew_lease(Tx& tx, const TaskRow& task);

/// What is left of the block of an ERODE or REFINE task.
std::vector<Range> left_of_block(Database& db, const JobRow& job, const TaskRow& task);

/// Milliseconds that a task may be leased without progress.
std::int64_t patience_ms(Tx& tx, const TaskRow& task);

/// Milliseconds since the worker was last heard of its task, had it, or was refused for want of room on the disk.
std::int64_t pause_ms(Tx& tx, const TaskRow& task);

/// Whether nobody wants the task any more.
bool is_cancelled(const TaskRow& task, const JobRow& job);

/// A result that the full disk cannot take.  Its worker will try again and keeps its leases meanwhile, those whose
/// results wait behind this one, too, unless the rest is not wanted any more.  To be thrown once that is committed.
std::exception_ptr refuse_for_now(Tx& tx, const TaskRow& task);

/// Ends the lease with the work finished; the token stays for a repeated last report.
void finish_task(Tx& tx, const TaskRow& task);

/// Ends the lease with work left (or none: a block of which nothing is left is finished).
void release_task(Tx& tx, const TaskRow& task);

/// Ends every lease, with no fault of its worker.
void release_all_leases(Tx& tx);

/// The lease was lost: counts it, releases it, and gives the task up after too many losses in a row.  A
/// worker that `may_come_back` keeps its token until another takes the task.
void lose_lease(Tx& tx, const TaskRow& task, const std::string& why, bool may_come_back);

/// Counts a failed attempt without progress; gives the task up with `error` when it was one too many.
void count_loss(Tx& tx, const TaskRow& task, const v1::JobError& error);

/// Fails the task for good: the request for the artefact, or the whole job.
void give_up(Tx& tx, const TaskRow& task, const v1::JobError& error);

}  // namespace affskel::server

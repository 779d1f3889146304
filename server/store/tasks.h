#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "affskel/v1/types.pb.h"
#include "affskel/v1/worker_service.pb.h"
#include "store/rows.h"
#include "store/tx.h"

namespace affskel::server {

/// A unit of work with its lease.
struct TaskRow {
  std::int64_t id = 0;
  std::string job_id;
  v1::TaskKind kind = v1::TASK_KIND_UNSPECIFIED;
  std::string state;
  bool on_request = false;
  Range block;         // ERODE
  std::string params;  // of the derived kinds: serialized
  std::string params_key;
  std::int64_t losses = 0;
  std::string worker;
  std::string host;
  std::string core_version;
  std::int64_t granted_ms = 0;
  std::optional<std::int64_t> reported_ms;
  std::int64_t lease_directions = 0;
};

std::optional<TaskRow> find_task(Database& db, std::int64_t id);

/// The task that holds this token: leased, done, or pending when its worker was silent and no other has
/// taken it since.
std::optional<TaskRow> find_task_of_token(Database& db, const std::string& token);
/// The same.  @throws StoreError kFenced when there is none.
TaskRow task_of_token(Database& db, const std::string& token);

/// The same for a worker that calls: what is still pending is leased to it again, with what it has computed.
/// A machine that was overloaded for a moment so loses nothing.  @throws StoreError kFenced
TaskRow held_task(Tx& tx, const std::string& token);
/// The same for a task that was found by its token.
TaskRow resume_if_late(Tx& tx, TaskRow task);

/// Adds a pending task in its place in the queue.  `block` for ERODE, `params` and `params_key` for the
/// derived kinds.
std::int64_t add_task(Tx& tx, const std::string& job_id, v1::TaskKind kind);
/// Somebody asks for lattice or directions that are lost.
std::int64_t add_prepare_request(Tx& tx, const std::string& job_id);
std::int64_t add_block(Tx& tx, const std::string& job_id, Range block);
std::int64_t add_derive_task(Tx& tx, const std::string& job_id, v1::TaskKind kind, const std::string& params,
                             const std::string& params_key, bool on_request);

/// Directions to be computed again by a worker that did not give them, see store/verification.h.
std::int64_t add_sample_task(Tx& tx, const std::string& job_id, const std::string& positions,
                             std::int64_t sample);

/// Renews the deadline.
void renew_lease(Tx& tx, const TaskRow& task);

/// Milliseconds that a task may be leased without progress.
std::int64_t patience_ms(Tx& tx, const TaskRow& task);

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

/// A job's stage ends, and the next one, which the caller sets, begins: counts how long it took.
void end_stage(Tx& tx, const std::string& job_id);

/// Fails an active job.
void fail_job(Tx& tx, const std::string& job_id, const v1::JobError& error);

/// Moves a job on as far as it can go without a worker: next stage, done, cancelled.  Called after every
/// change to its tasks.
void settle_job(Tx& tx, const std::string& job_id);

/// Marks the pending blocks as done of which nothing is left.
void finish_whole_blocks(Tx& tx, const std::string& job_id);

/// Moves on the jobs whose last block ended when there was no room for their fields.
void settle_finished_blocks(Tx& tx);

}  // namespace affskel::server

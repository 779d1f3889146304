#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "database/sqlite.h"
#include "store/task_rows.h"
#include "store/tx.h"

namespace affskel::server {

/// A worker that asks for a task.
struct Seeker {
  std::string worker;         ///< its id
  std::string core_version;   ///< fields of different ones are never mixed
  std::string preferred_job;  ///< whose mesh and field it holds; empty = none
  std::int64_t memory = std::numeric_limits<std::int64_t>::max();  ///< bytes
};

/// The ready task whose turn it is, or nothing.
///
/// Of the tasks that the worker can do, those of the highest rank count: the priority, as far as the owner's
/// quota allows.  Among their owners it is the turn of the one whose last grant lies back furthest, and among
/// the owner's tasks of the highest priority, as `order` says, that of the oldest job, or of the job whose
/// last grant lies back furthest.  But a worker goes on with the job that it holds (instead of reading
/// another mesh for every block) where no owner is worse off: its owner then has no more workers than the one
/// whose turn it is and, where jobs take turns, the job no more than its owner's next one.
///
/// A few steps in an index for each core version and each amount of memory that tasks need, however many
/// wait. A function of database and seeker: the same after a restart.
///
/// @param on_request requests for artefacts, instead of the jobs' own tasks; the job that is held is no
/// matter.
std::optional<std::int64_t> task_in_turn(Database& db, const Seeker& seeker, bool on_request,
                                         OwnerOrder order);

/// The task is granted: its owner's next turn comes after all others', and where jobs take turns, its job's.
void end_turn(Tx& tx, const TaskRow& task);

/// Makes turns and ranks of jobs those of the order and the quotas that the store was opened with.
void settle_turns(Tx& tx);

}  // namespace affskel::server

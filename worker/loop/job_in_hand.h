#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "affskel/v1/worker_service.pb.h"
#include "job/job_shelf.h"
#include "job/prepared_job.h"
#include "link/server_link.h"
#include "link/task_context.h"

namespace affskel::worker {

struct JobInHandOptions {
  unsigned threads = 1;
  std::uint64_t memory = 0;            ///< bytes that the worker may take; 0 = what is available
  std::uint64_t shelf_bytes = 0;       ///< for the jobs that were left
  std::chrono::seconds prepare_limit;  ///< see TaskLimit
};

/// The job that a worker works on, kept between tasks of the same job, and on a shelf while it is others'
/// turn.  One thread.
class JobInHand {
 public:
  /// `link` must outlive it.
  JobInHand(ServerLink& link, const JobInHandOptions& options);

  /// Of the job in hand; empty when there is none.
  const std::string& id() const { return id_; }
  /// Whether it is the job of this lease, with its field.
  bool is_of(const v1::Lease& lease) const;

  /// The job of the lease: the one in hand, else from the shelf, else made from the mesh; without a field when it was of
  /// another one.  One that is in hand for another lease goes to the shelf: all of its field must be acknowledged.
  PreparedJob& obtain(const v1::Lease& lease, TaskContext& context);

  /// To be called whenever the erosion's field may hold work that the server did not acknowledge: such points
  /// would not be reported again.
  void forget();

  /// Forgets the jobs that were left, for want of memory.
  void clear_shelf() { shelf_.clear(); }

 private:
  void make(const v1::Lease& lease, TaskContext& context);
  std::uint64_t memory_left() const;

  ServerLink& link_;
  const JobInHandOptions options_;
  std::unique_ptr<PreparedJob> job_;
  std::string id_;
  std::string field_;  // of Lease.field
  JobShelf shelf_;
};

/// Points and directions are sent by number: server and worker must number the same ones.
/// @throws core::CoreError when they do not.
void require_same_job(const v1::Lease& lease, const PreparedJob& job);

}  // namespace affskel::worker

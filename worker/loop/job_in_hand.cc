#include "loop/job_in_hand.h"

#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include "core/base/error.h"
#include "core/lattice/lattice_memory.h"
#include "job/available_memory.h"
#include "job/task_limit.h"
#include "wire/memory_sizes.h"

namespace affskel::worker {
namespace {

// Jobs of versions without frames have none stored: their lattice is parallel to the axes of the mesh.
bool same_frame(const v1::PreparedSummary& stored, const v1::PreparedSummary& own) {
  constexpr std::array<double, 9> kMesh = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const auto frame_is = [&](const auto& frame) {
    return std::equal(frame.begin(), frame.end(), own.frame().begin(), own.frame().end());
  };
  return stored.frame_size() == 0 ? frame_is(kMesh) : frame_is(stored.frame());
}

bool is_same_job(const v1::Lease& lease, const PreparedJob& job) {
  const v1::PreparedSummary& stored = lease.job().prepared();
  const v1::PreparedSummary own = job.summary();
  return own.points() == stored.points() && own.spacing() == stored.spacing() &&
         own.directions() == lease.job().directions_total() && same_frame(stored, own);
}

// The job's parameters with the spacing that its prepare task found.  The search for it compares doubles:
// done anew, on another machine, it may end one rounding away, at another lattice.
v1::ErosionParams prepared_params(const v1::Job& job) {
  v1::ErosionParams params = job.params();
  if (job.has_prepared() && !params.sampling().has_spacing()) {
    params.mutable_sampling()->set_spacing(job.prepared().spacing());
  }
  return params;
}

}  // namespace

JobInHand::JobInHand(ServerLink& link, const JobInHandOptions& options)
    : link_(link), options_(options), shelf_(options.shelf_bytes) {}

bool JobInHand::is_of(const v1::Lease& lease) const {
  return job_ && id_ == lease.job().id() && field_ == lease.field();
}

PreparedJob& JobInHand::obtain(const v1::Lease& lease, TaskContext& context) {
  if (is_of(lease)) return *job_;
  if (job_ && id_ == lease.job().id()) {
    job_->forget_field();
  } else {
    if (job_) shelf_.put({id_, field_, std::move(job_)});
    job_ = shelf_.take(lease.job().id(), lease.field());
  }
  id_.clear();
  // With its field the server may have forgotten its lattice, and have had another one laid.
  if (job_ && lease.job().has_prepared() && !is_same_job(lease, *job_)) job_.reset();
  if (job_ == nullptr) make(lease, context);
  id_ = lease.job().id();
  field_ = lease.field();
  return *job_;
}

void JobInHand::forget() {
  job_.reset();
  id_.clear();
}

void JobInHand::make(const v1::Lease& lease, TaskContext& context) {
  const std::string mesh = link_.fetch(lease.token(), v1::ARTIFACT_KIND_MESH, context.token());
  // A prepared job has fitted into the memory of some worker: one that is short of it must not fail the job
  // for all.
  const bool first = lease.kind() == v1::TASK_KIND_PREPARE;
  // For the same reason only the first is bound in its time.
  TaskLimit limit(context, first ? options_.prepare_limit : std::chrono::seconds(0), kPreparing);
  try {
    job_ = std::make_unique<PreparedJob>(
        mesh, prepared_params(lease.job()), options_.threads, &limit,
        first ? std::function<std::uint64_t()>([this] { return memory_left(); })
              : std::function<std::uint64_t()>(),
        static_cast<double>(wire::skeleton_bytes_per_point(lease.job().skeleton().operator_())));
  } catch (const core::LatticeMemoryError&) {
    throw;
  } catch (const core::CoreError& error) {
    throw limit.reason(error);
  }
}

/// Bytes that may be taken now; 0 when nothing is known.
std::uint64_t JobInHand::memory_left() const {
  const std::uint64_t left = available_memory();
  if (options_.memory == 0) return left;
  const std::uint64_t own = options_.memory - std::min(options_.memory, shelf_.bytes());
  return left == 0 ? own : std::min(left, own);
}

void require_same_job(const v1::Lease& lease, const PreparedJob& job) {
  if (!is_same_job(lease, job)) {
    throw core::CoreError(core::CoreError::Code::kInternal,
                          "this worker's core lays another lattice than the one that prepared the job");
  }
}

}  // namespace affskel::worker

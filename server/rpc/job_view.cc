#include "rpc/job_view.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "database/errors.h"

namespace affskel::server {

namespace {

std::string megabytes(std::uint64_t bytes) {
  return std::to_string((bytes + 999'999) / 1'000'000) + " MB";
}

/// Why none of the workers is offered a task that needs so much memory; "" when one is, or there are none.
std::string too_large_for(const std::vector<v1::WorkerInfo>& workers, std::uint64_t need) {
  std::uint64_t most = 0;
  for (const v1::WorkerInfo& worker : workers) {
    if (worker.memory() == 0 || worker.memory() >= need) return {};
    most = std::max(most, worker.memory());
  }
  if (workers.empty()) return {};
  return "needs a worker with about " + megabytes(need) + " of memory, and the largest of " +
         std::to_string(workers.size()) + " has " + megabytes(most) +
         "; start one with more, or cancel it and take a wider spacing";
}

}  // namespace

EventHub::JobPtr JobView::load(const std::string& job_id) const {
  try {
    return std::make_shared<const v1::Job>(with_reason(store_.job(job_id)));
  } catch (const StoreError& error) {
    if (error.code() == StoreError::Code::kNotFound) return nullptr;
    throw;
  }
}

v1::Job JobView::with_reason(v1::Job job) const {
  const bool active = job.state() == v1::JOB_STATE_QUEUED || job.state() == v1::JOB_STATE_RUNNING;
  if (active && store_.disk_full()) {
    job.set_waiting_reason("the server's disk is full; it goes on when there is room");
    return job;
  }
  if (!active || !job.waiting_reason().empty()) return job;
  std::vector<v1::WorkerInfo> workers = registry_.list();
  std::erase_if(workers, [](const v1::WorkerInfo& worker) { return worker.silent(); });
  if (const std::string why = too_large_for(workers, job.memory_needed()); !why.empty()) {
    job.set_waiting_reason(why);
    return job;
  }
  if (job.state() != v1::JOB_STATE_QUEUED) return job;
  const auto idle = [](const v1::WorkerInfo& worker) { return worker.task().empty(); };
  if (workers.empty()) {
    job.set_waiting_reason("no worker is connected");
  } else if (std::none_of(workers.begin(), workers.end(), idle)) {
    job.set_waiting_reason("all workers are busy with jobs whose turn came before its");
  }
  return job;
}

}  // namespace affskel::server

#include "rpc/job_view.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "database/errors.h"

namespace affskel::server {

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
  if (job.state() != v1::JOB_STATE_QUEUED || !job.waiting_reason().empty()) return job;
  std::vector<v1::WorkerInfo> workers = registry_.list();
  std::erase_if(workers, [](const v1::WorkerInfo& worker) { return worker.silent(); });
  const auto idle = [](const v1::WorkerInfo& worker) { return worker.task().empty(); };
  if (workers.empty()) {
    job.set_waiting_reason("no worker is connected");
  } else if (std::none_of(workers.begin(), workers.end(), idle)) {
    job.set_waiting_reason("all workers are busy with jobs before it");
  }
  return job;
}

}  // namespace affskel::server

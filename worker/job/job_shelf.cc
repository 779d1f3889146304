#include "job/job_shelf.h"

#include <algorithm>
#include <utility>

#include "wire/memory_sizes.h"

namespace affskel::worker {

std::uint64_t bytes_of(const PreparedJob& job) {
  const bool refine = job.has_refinement();
  return job.solid().mesh.triangles.size() *
             (wire::kBytesPerTriangle + (refine ? wire::kRefineBytesPerTriangle : 0)) +
         job.lattice().points * (wire::kBytesPerPoint + (refine ? wire::kRefineBytesPerPoint : 0));
}

void JobShelf::put(ShelvedJob job) {
  jobs_.push_front(std::move(job));
  while (!jobs_.empty() && bytes() > budget_) jobs_.pop_back();
}

std::unique_ptr<PreparedJob> JobShelf::take(const std::string& id, const std::string& field) {
  const auto found =
      std::find_if(jobs_.begin(), jobs_.end(), [&](const ShelvedJob& shelved) { return shelved.id == id; });
  if (found == jobs_.end()) return nullptr;
  std::unique_ptr<PreparedJob> job = std::move(found->job);
  if (found->field != field) job->forget_field();
  jobs_.erase(found);
  return job;
}

std::uint64_t JobShelf::bytes() const {
  std::uint64_t sum = 0;
  for (const ShelvedJob& shelved : jobs_) sum += bytes_of(*shelved.job);
  return sum;
}

}  // namespace affskel::worker

#include "services/job_view.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "database/errors.h"

namespace affskel::server {
namespace {

constexpr std::chrono::milliseconds kBusyFor{200};  // a count of what workers are busy with holds

/// Workers that are busy, seen from a job that waits for one of them.
struct Rivals {
  std::int64_t higher = 0;  ///< with jobs of a higher priority
  std::int64_t own = 0;     ///< with jobs of its owner
  std::int64_t others = 0;  ///< with jobs of other owners
};

/// @param most highest priority of the owner's jobs that counts across owners.
Rivals rivals_of(const v1::Job& job, std::int64_t most, const std::vector<BusyWith>& busy) {
  Rivals rivals;
  const std::int64_t priority = job.priority();
  for (const BusyWith& with : busy) {
    const bool higher =
        with.owner == job.owner() ? with.priority > priority : with.rank > std::min(priority, most);
    (higher ? rivals.higher : with.owner == job.owner() ? rivals.own : rivals.others) += with.workers;
  }
  return rivals;
}

/// Says nothing of other owners but how many workers they have.
std::string busy_text(std::size_t workers, const Rivals& rivals) {
  std::vector<std::pair<std::int64_t, const char*>> with = {{rivals.higher, "jobs of higher priority"},
                                                            {rivals.own, "jobs of the same owner"},
                                                            {rivals.others, "other owners' jobs"}};
  std::erase_if(with, [](const auto& part) { return part.first == 0; });
  std::string text =
      workers == 1 ? "the only worker is busy" : "all " + std::to_string(workers) + " workers are busy";
  if (with.size() == 1) return text + " with " + with.front().second;
  for (std::size_t i = 0; i < with.size(); ++i) {
    text += (i == 0 ? ": " : ", ") + std::to_string(with[i].first) + " with " + with[i].second;
  }
  return text;
}

constexpr std::uint64_t kMegabyte = 1'000'000;
constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

/// Why none of the workers is offered a task that needs so much memory; "" when one is, or there are none.
std::string too_large_for(const std::vector<WorkerRegistry::Present>& workers, std::uint64_t need) {
  std::uint64_t most = 0;
  for (const WorkerRegistry::Present& worker : workers) {
    if (worker.memory == 0 || worker.memory >= need) return {};
    most = std::max(most, worker.memory);
  }
  if (workers.empty()) return {};
  return "needs a worker with about " + std::to_string((need + kMegabyte - 1) / kMegabyte) +
         " MB of memory, and the largest of " + std::to_string(workers.size()) + " has " +
         std::to_string(most / kMegabyte) + " MB; start one with more, or cancel it and take a wider spacing";
}

}  // namespace

/// What decides why jobs wait, as it is now; read when the first of them asks.
class JobView::Reasons {
 public:
  explicit Reasons(const JobView& view) : view_(view), store_(view.store_), registry_(view.registry_) {}

  void add_to(v1::Job& job) {
    const bool active = job.state() == v1::JOB_STATE_QUEUED || job.state() == v1::JOB_STATE_RUNNING;
    if (const std::uint64_t wanted = active ? store_.room_wanted(job.id()) : 0; wanted > 0) {
      return job.set_waiting_reason("the server's disk is full; it tries again once " +
                                    std::to_string((wanted + kMebibyte - 1) / kMebibyte) + " MiB are free");
    }
    if (!active || !job.waiting_reason().empty()) return;
    const std::vector<WorkerRegistry::Present>& workers = connected();
    if (const std::string why = too_large_for(workers, job.memory_needed()); !why.empty()) {
      return job.set_waiting_reason(why);
    }
    if (job.state() != v1::JOB_STATE_QUEUED) return;
    const auto idle = [](const WorkerRegistry::Present& worker) { return !worker.busy; };
    if (workers.empty()) {
      job.set_waiting_reason("no worker is connected");
    } else if (std::none_of(workers.begin(), workers.end(), idle)) {
      if (!busy_) busy_ = view_.busy();
      job.set_waiting_reason(busy_text(
          workers.size(), rivals_of(job, store_.options().policy.of(job.owner()).priority, *busy_)));
    }
  }

 private:
  const std::vector<WorkerRegistry::Present>& connected() {
    if (!workers_) workers_ = registry_.present();
    return *workers_;
  }

  const JobView& view_;
  Store& store_;
  const WorkerRegistry& registry_;
  std::optional<std::vector<WorkerRegistry::Present>> workers_;
  std::shared_ptr<const std::vector<BusyWith>> busy_;
};

EventHub::JobPtr JobView::load(const std::string& job_id) const {
  try {
    return std::make_shared<const v1::Job>(with_reason(store_.job(job_id)));
  } catch (const StoreError& error) {
    if (error.code() == StoreError::Code::kNotFound) return nullptr;
    throw;
  }
}

std::shared_ptr<const std::vector<BusyWith>> JobView::busy() const {
  const base::MutexLock lock(mutex_);
  const auto now = std::chrono::steady_clock::now();
  if (!busy_ || now - counted_ > kBusyFor) {
    busy_ = std::make_shared<const std::vector<BusyWith>>(store_.busy_with());
    counted_ = now;
  }
  return busy_;
}

v1::Job JobView::with_reason(v1::Job job) const {
  Reasons(*this).add_to(job);
  return job;
}

void JobView::add_reasons(std::vector<v1::Job>& jobs) const {
  Reasons reasons(*this);
  for (v1::Job& job : jobs) reasons.add_to(job);
}

void JobView::add_reason(v1::Verification& verification) const {
  std::vector<v1::WorkerInfo> workers = registry_.list();
  const std::set<std::string> distrusted = store_.distrusted();
  std::erase_if(workers, [&](const v1::WorkerInfo& worker) {
    return worker.silent() || distrusted.contains(worker.id()) || distrusted.contains(worker.host());
  });
  if (!verification.finished() && workers.empty()) {
    return verification.set_waiting_reason("no worker is connected");
  }
  for (const v1::VerifiedSample& sample : verification.samples()) {
    const bool other = std::any_of(workers.begin(), workers.end(), [&](const v1::WorkerInfo& worker) {
      return std::none_of(sample.givers().begin(), sample.givers().end(),
                          [&](const v1::Giver& giver) { return giver.worker() == worker.id(); });
    });
    if (sample.finished() || other) continue;
    return verification.set_waiting_reason(
        "needs a worker that did not give these directions itself; connect another one");
  }
}

}  // namespace affskel::server

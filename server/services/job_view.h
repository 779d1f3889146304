#pragma once

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "affskel/v1/client_service.pb.h"
#include "base/mutex.h"
#include "scheduling/worker_registry.h"
#include "services/event_hub.h"
#include "store/store.h"

namespace affskel::server {

/// Jobs as clients see them: what the store knows, and why they wait.  Thread-safe.
class JobView {
 public:
  JobView(Store& store, const WorkerRegistry& registry) : store_(store), registry_(registry) {}

  /// The job as it is now; null when there is none.  Throws what the store throws otherwise.
  EventHub::JobPtr load(const std::string& job_id) const;

  /// Adds the reason why it waits, if it does.
  v1::Job with_reason(v1::Job job) const;
  /// The same for many.
  void add_reasons(std::vector<v1::Job>& jobs) const;
  /// Adds the reason why a verification gets no further, if there is one.
  void add_reason(v1::Verification& verification) const;

 private:
  class Reasons;

  /// With what workers are busy, as of a moment ago: a crowd that asks does not make the server count for
  /// each.
  std::shared_ptr<const std::vector<BusyWith>> busy() const;

  Store& store_;
  const WorkerRegistry& registry_;
  mutable base::Mutex mutex_;
  mutable std::shared_ptr<const std::vector<BusyWith>> busy_ ABSL_GUARDED_BY(mutex_);
  mutable std::chrono::steady_clock::time_point counted_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server

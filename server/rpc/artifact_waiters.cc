#include "rpc/artifact_waiters.h"
#include "base/mutex.h"

namespace affskel::server {

void ArtifactWaiters::join(std::int64_t task) {
  base::MutexLock lock(mutex_);
  withdrawn_.wait(lock, [&] {
    mutex_.assert_held();
    return !going_.contains(task);
  });
  ++waiting_[task];
}

void ArtifactWaiters::leave(std::int64_t task) {
  const base::MutexLock lock(mutex_);
  leave_locked(task);
}

void ArtifactWaiters::give_up(std::int64_t task) {
  {
    const base::MutexLock lock(mutex_);
    if (!leave_locked(task) || closed_) return;
    going_.insert(task);
  }
  withdraw_(task);
  {
    const base::MutexLock lock(mutex_);
    going_.erase(task);
  }
  withdrawn_.notify_all();
}

/// Whether that was the last one.
bool ArtifactWaiters::leave_locked(std::int64_t task) {
  const auto found = waiting_.find(task);
  if (found == waiting_.end() || --found->second > 0) return false;
  waiting_.erase(found);
  return true;
}

void ArtifactWaiters::close() {
  const base::MutexLock lock(mutex_);
  closed_ = true;
}

std::size_t ArtifactWaiters::count(std::int64_t task) const {
  const base::MutexLock lock(mutex_);
  const auto found = waiting_.find(task);
  return found == waiting_.end() ? 0 : found->second;
}

}  // namespace affskel::server

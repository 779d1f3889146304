#include "services/artifact_waiters.h"
#include "base/mutex.h"

namespace affskel::server {

void ArtifactWaiters::join(std::int64_t task) {
  base::MutexLock lock(mutex_);
  withdrawn_.wait(lock, [&] {
    mutex_.assert_held();
    return !going_.contains(task);
  });
  left_.erase(task);
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
  withdraw(task);
}

void ArtifactWaiters::retry() {
  for (;;) {
    std::int64_t task = 0;
    {
      const base::MutexLock lock(mutex_);
      if (left_.empty() || closed_) return;
      task = *left_.begin();
      left_.erase(task);
      going_.insert(task);
    }
    if (!withdraw(task)) return;
  }
}

/// A task that is among those going; afterwards it is gone, or left for later.
bool ArtifactWaiters::withdraw(std::int64_t task) {
  const bool withdrawn = withdraw_(task);
  {
    const base::MutexLock lock(mutex_);
    going_.erase(task);
    if (!withdrawn) left_.insert(task);
  }
  withdrawn_.notify_all();
  return withdrawn;
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

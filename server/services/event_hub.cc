#include "services/event_hub.h"

#include <chrono>
#include <new>
#include <utility>
#include <vector>

#include "base/mutex.h"
#include "calls/status.h"

namespace affskel::server {
namespace {

// Between two tries to tell what could not be told.
constexpr std::chrono::milliseconds kTryAgain{100};

}  // namespace

EventHub::Subscription::Subscription(EventHub* hub, std::string job, std::uint64_t number)
    : hub_(hub), job_(std::move(job)), number_(number) {}

EventHub::Subscription::Subscription(Subscription&& other) noexcept
    : hub_(std::exchange(other.hub_, nullptr)), job_(std::move(other.job_)), number_(other.number_) {}

EventHub::Subscription& EventHub::Subscription::operator=(Subscription&& other) noexcept {
  if (this != &other) {
    end();
    hub_ = std::exchange(other.hub_, nullptr);
    job_ = std::move(other.job_);
    number_ = other.number_;
  }
  return *this;
}

EventHub::Subscription::~Subscription() {
  end();
}

void EventHub::Subscription::end() {
  if (hub_ != nullptr) std::exchange(hub_, nullptr)->unsubscribe(job_, number_);
}

EventHub::~EventHub() {
  stop();
}

void EventHub::start(Loader load, std::function<void()> on_work) {
  load_ = std::move(load);
  on_work_ = std::move(on_work);
  thread_ = std::thread([this] { run(); });
}

void EventHub::stop() {
  {
    const base::MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

EventHub::Subscription EventHub::subscribe(const std::string& job_id, JobCallback callback, bool at_once) {
  std::uint64_t number = 0;
  {
    const base::MutexLock lock(mutex_);
    number = next_number_++;
    subscribers_[job_id][number] = std::make_shared<JobCallback>(std::move(callback));
    if (at_once) fresh_[number] = job_id;
  }
  changed_.notify_all();
  return {this, job_id, number};
}

void EventHub::unsubscribe(const std::string& job_id, std::uint64_t number) {
  std::shared_ptr<JobCallback> last;  // destroyed after the lock is gone: it may own a subscription
  const base::MutexLock lock(mutex_);
  const auto of_job = subscribers_.find(job_id);
  if (of_job == subscribers_.end()) return;
  const auto found = of_job->second.find(number);
  if (found == of_job->second.end()) return;
  last = std::move(found->second);
  of_job->second.erase(found);
  if (of_job->second.empty()) subscribers_.erase(of_job);
}

void EventHub::on_change(const Changes& changes) {
  if (changes.jobs.empty() && !changes.work) return;
  {
    const base::MutexLock lock(mutex_);
    work_ = work_ || changes.work;
    try {
      jobs_.insert(changes.jobs.begin(), changes.jobs.end());
    } catch (const std::bad_alloc&) {
      all_ = true;  // the change is committed: the calls that wait for it must hear of it
    }
  }
  changed_.notify_all();
}

void EventHub::run() {
  base::MutexLock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] {
      mutex_.assert_held();
      return stopping_ || work_ || all_ || !jobs_.empty() || !fresh_.empty();
    });
    if (stopping_) return;
    const bool work = std::exchange(work_, false);
    const bool all = std::exchange(all_, false);
    const std::set<std::string> jobs = std::exchange(jobs_, {});
    const std::map<std::uint64_t, std::string> fresh = std::exchange(fresh_, {});
    lock.unlock();
    if (work) on_work_();
    const bool told = all ? notify_all() : notify_some(jobs, fresh);
    lock.lock();
    if (told) continue;
    // For want of memory or of the disk.  No call may wait for ever for what was not told.
    all_ = true;
    changed_.wait_for(lock, kTryAgain, [this] {
      mutex_.assert_held();
      return stopping_;
    });
  }
}

bool EventHub::notify_some(const std::set<std::string>& jobs,
                           const std::map<std::uint64_t, std::string>& fresh) {
  bool told = true;
  for (const std::string& job : jobs) told = notify(job) && told;
  for (const auto& [number, job] : fresh) {
    if (!jobs.contains(job)) told = notify(job, number) && told;
  }
  return told;
}

/// The newest state of every job that is followed.
bool EventHub::notify_all() {
  bool told = true;
  return guarded([&] {
           std::set<std::string> jobs;
           {
             const base::MutexLock lock(mutex_);
             for (const auto& [job, callbacks] : subscribers_) jobs.insert(job);
           }
           for (const std::string& job : jobs) told = notify(job) && told;
         }).ok() &&
         told;
}

/// Tells all subscribers of a job, or only one.  False when that must be tried again.
bool EventHub::notify(const std::string& job_id, std::uint64_t only) {
  return guarded([&] {
           std::vector<std::shared_ptr<JobCallback>> callbacks;
           {
             const base::MutexLock lock(mutex_);
             const auto found = subscribers_.find(job_id);
             if (found == subscribers_.end()) return;
             for (const auto& [number, callback] : found->second) {
               if (only == 0 || only == number) callbacks.push_back(callback);
             }
           }
           const JobPtr job = load_(job_id);
           for (const auto& callback : callbacks) (*callback)(job);
         })
      .ok();
}

}  // namespace affskel::server

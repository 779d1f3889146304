#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "affskel/v1/types.pb.h"
#include "base/mutex.h"
#include "store/tx.h"

namespace affskel::server {

/// Notifies subscribers of what the store has committed.  Changes of a job that come faster than
/// notifications are merged: subscribers get the newest state once.  Thread-safe.
class EventHub final : public ChangeListener {
 public:
  /// The job as it is now; null when it was deleted.
  using JobPtr = std::shared_ptr<const v1::Job>;
  using JobCallback = std::function<void(const JobPtr&)>;
  using Loader = std::function<JobPtr(const std::string& id)>;

  /// Ends a subscription on destruction.  A call that is under way may still come to its end after that:
  /// callbacks own what they use.
  class Subscription {
   public:
    Subscription() = default;
    Subscription(Subscription&& other) noexcept;
    Subscription& operator=(Subscription&& other) noexcept;
    ~Subscription();

   private:
    friend class EventHub;
    Subscription(EventHub* hub, std::string job, std::uint64_t number);
    void end();
    EventHub* hub_ = nullptr;
    std::string job_;
    std::uint64_t number_ = 0;
  };

  EventHub() = default;
  ~EventHub() override;

  /// Starts telling.  `load` and `on_work` are called on the hub's own thread; what cannot be told,
  /// because the job cannot be read or memory is short, is tried again until it is.
  void start(Loader load, std::function<void()> on_work);
  void stop();

  /// Calls `callback` after every change of the job, and with `at_once` for the job as it is.  All calls
  /// come from one thread in the order of what they tell: never an older state after a newer one.
  Subscription subscribe(const std::string& job_id, JobCallback callback, bool at_once = false);
  void on_change(const Changes& changes) override;

 private:
  void run();
  bool notify_some(const std::set<std::string>& jobs, const std::map<std::uint64_t, std::string>& fresh);
  bool notify_all();
  bool notify(const std::string& job_id, std::uint64_t only = 0);
  void unsubscribe(const std::string& job_id, std::uint64_t number);

  Loader load_;
  std::function<void()> on_work_;

  base::Mutex mutex_;
  std::condition_variable_any changed_;
  std::map<std::string, std::map<std::uint64_t, std::shared_ptr<JobCallback>>> subscribers_
      ABSL_GUARDED_BY(mutex_);
  std::set<std::string> jobs_ ABSL_GUARDED_BY(mutex_);  // changed and not told yet
  std::map<std::uint64_t, std::string> fresh_
      ABSL_GUARDED_BY(mutex_);  // subscriptions that have heard nothing yet, with their jobs
  bool work_ ABSL_GUARDED_BY(mutex_) = false;
  bool all_ ABSL_GUARDED_BY(mutex_) =
      false;  // something was not told: tell the state of every job that is followed
  bool stopping_ ABSL_GUARDED_BY(mutex_) = false;
  std::uint64_t next_number_ ABSL_GUARDED_BY(mutex_) = 1;
  std::thread thread_;
};

}  // namespace affskel::server

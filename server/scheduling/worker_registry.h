#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "affskel/v1/client_service.pb.h"
#include "affskel/v1/worker_service.pb.h"
#include "base/mutex.h"
#include "store/clock.h"

namespace affskel::server {

/// The workers heard from lately.  Only for people to look at: scheduling relies on leases alone.
/// Thread-safe.
class WorkerRegistry {
 public:
  /// @param silence_ms a worker that calls no more for this long is silent: a lease's length.
  WorkerRegistry(const Clock& clock, std::int64_t silence_ms) : clock_(clock), silence_ms_(silence_ms) {}

  /// A worker process that this server has started, or that has ended.
  void add_supervised(std::uint32_t pid);
  void remove_supervised(std::uint32_t pid);
  /// Whether a worker is one of ours: started by us, on this host.
  bool is_supervised(const v1::WorkerIdentity& worker) const;

  /// A worker asks for work, and will say nothing else for as long as it wants to wait for some.  Of more
  /// than a few thousand workers, those not heard from for longest are forgotten.
  void seen(const v1::WorkerIdentity& worker, std::uint32_t wait_ms);
  /// A worker got a lease, uses it, has ended it.
  void granted(const v1::WorkerIdentity& worker, const v1::Lease& lease);
  void used(const std::string& token);
  void ended(const std::string& token);

  /// What of a worker decides whether jobs wait.
  struct Present {
    std::uint64_t memory = 0;  ///< bytes; 0: it does not say
    bool busy = false;
  };
  /// Those that are not silent.
  std::vector<Present> present() const;
  /// Heard from in the last minute.
  std::vector<v1::WorkerInfo> list() const;

 private:
  struct Entry {
    std::int64_t heard_ms = 0;  // lease clock
    v1::WorkerInfo info;
    std::map<std::string, std::string> tasks;  // by token: what for people
    std::int64_t wait_ms = 0;                  // of the call under way
  };
  std::int64_t oldest_ms() const;
  void hear(Entry& entry) const;
  void forget_silent() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void forget_one() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool is_silent(const Entry& entry) const;

  const Clock& clock_;
  const std::int64_t silence_ms_;
  mutable base::Mutex mutex_;
  std::map<std::string, Entry> workers_ ABSL_GUARDED_BY(mutex_);        // by id
  std::map<std::string, std::string> holders_ ABSL_GUARDED_BY(mutex_);  // token -> id
  std::set<std::uint32_t> supervised_ ABSL_GUARDED_BY(mutex_);
};

}  // namespace affskel::server

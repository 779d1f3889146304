#pragma once

#include <cstdint>
#include "base/mutex.h"

namespace affskel::server {

/// Bytes that calls hold in memory until they are stored, over all calls.  Bounds what many clients at once
/// can make the server hold.  Thread-safe.
class UploadBudget {
 public:
  explicit UploadBudget(std::uint64_t limit) : limit_(limit) {}

  std::uint64_t limit() const { return limit_; }
  /// Bytes held by all calls.
  std::uint64_t used() const {
    const base::MutexLock lock(mutex_);
    return used_;
  }

  /// What one call holds, until it ends.  Used by one thread at a time.
  class Share {
   public:
    /// @param left_over bytes of the budget that this call must leave to others.
    explicit Share(UploadBudget& budget, std::uint64_t left_over = 0)
        : budget_(budget), left_over_(left_over) {}
    ~Share() { give_back(); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// Takes more; false when all calls together would exceed the limit.
    bool take(std::uint64_t bytes) {
      if (!budget_.take(bytes, left_over_)) return false;
      bytes_ += bytes;
      return true;
    }

    /// Gives all of it back.
    void give_back() {
      budget_.give_back(bytes_);
      bytes_ = 0;
    }

   private:
    UploadBudget& budget_;
    const std::uint64_t left_over_;
    std::uint64_t bytes_ = 0;
  };

 private:
  bool take(std::uint64_t bytes, std::uint64_t left_over) {
    const base::MutexLock lock(mutex_);
    const std::uint64_t taken = used_ + left_over;
    if (taken > limit_ || bytes > limit_ - taken) return false;
    used_ += bytes;
    return true;
  }
  void give_back(std::uint64_t bytes) {
    const base::MutexLock lock(mutex_);
    used_ -= bytes;
  }

  const std::uint64_t limit_;
  mutable base::Mutex mutex_;
  std::uint64_t used_ ABSL_GUARDED_BY(mutex_) = 0;
};

}  // namespace affskel::server

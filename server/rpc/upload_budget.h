#pragma once

#include <cstdint>
#include <mutex>

namespace affskel::server {

/// Bytes of uploads that lie in memory until they are stored, over all calls.  Bounds what many clients at
/// once can make the server hold.  Thread-safe.
class UploadBudget {
 public:
  explicit UploadBudget(std::uint64_t limit) : limit_(limit) {}

  std::uint64_t limit() const { return limit_; }

  /// What one call holds, until it ends.  Used by one thread.
  class Share {
   public:
    explicit Share(UploadBudget& budget) : budget_(budget) {}
    ~Share() { budget_.give_back(bytes_); }
    Share(const Share&) = delete;
    Share& operator=(const Share&) = delete;

    /// Takes more; false when all calls together would exceed the limit.
    bool take(std::uint64_t bytes) {
      if (!budget_.take(bytes)) return false;
      bytes_ += bytes;
      return true;
    }

   private:
    UploadBudget& budget_;
    std::uint64_t bytes_ = 0;
  };

 private:
  bool take(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    if (bytes > limit_ - used_) return false;
    used_ += bytes;
    return true;
  }
  void give_back(std::uint64_t bytes) {
    const std::lock_guard lock(mutex_);
    used_ -= bytes;
  }

  const std::uint64_t limit_;
  std::mutex mutex_;
  std::uint64_t used_ = 0;  // guarded by mutex_
};

}  // namespace affskel::server

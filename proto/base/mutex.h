#pragma once

#include <absl/base/thread_annotations.h>

#include <mutex>

namespace affskel::base {

/// std::mutex for Clang's thread safety analysis: members that it guards are marked ABSL_GUARDED_BY(mutex_),
/// private functions that are called with it held ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_), and a build with
/// -Wthread-safety refuses every other access.  (absl::Mutex would be marked already, but ThreadSanitizer
/// does not see into Debian's.)
class ABSL_LOCKABLE Mutex {
 public:
  void lock() ABSL_EXCLUSIVE_LOCK_FUNCTION() { mutex_.lock(); }
  void unlock() ABSL_UNLOCK_FUNCTION() { mutex_.unlock(); }
  /// Tells the analysis, at the beginning of a lambda that only runs so, that the mutex is held.
  void assert_held() const ABSL_ASSERT_EXCLUSIVE_LOCK() {}

 private:
  std::mutex mutex_;
};

/// Holds a Mutex from construction to destruction, but for what lies between unlock() and lock(), as the
/// waits of std::condition_variable_any call them.
class ABSL_SCOPED_LOCKABLE MutexLock {
 public:
  explicit MutexLock(Mutex& mutex) ABSL_EXCLUSIVE_LOCK_FUNCTION(mutex) : mutex_(mutex) { mutex_.lock(); }
  ~MutexLock() ABSL_UNLOCK_FUNCTION() {
    if (held_) mutex_.unlock();
  }
  MutexLock(const MutexLock&) = delete;
  MutexLock& operator=(const MutexLock&) = delete;

  void lock() ABSL_EXCLUSIVE_LOCK_FUNCTION() {
    mutex_.lock();
    held_ = true;
  }
  void unlock() ABSL_UNLOCK_FUNCTION() {
    held_ = false;
    mutex_.unlock();
  }

 private:
  Mutex& mutex_;
  bool held_ = true;
};

}  // namespace affskel::base

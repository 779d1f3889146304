#pragma once

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "base/mutex.h"
#include "http/limits.h"

namespace affskel::http {

/// Threads on which answers are made.  Those that ask take turns, so that one with many requests
/// delays only itself.  Thread-safe.
class AnswerThreads {
 public:
  /// An answer to be made.
  struct Work {
    std::string whose;           ///< the asker that takes turns
    std::function<void()> run;   ///< must not throw
    std::stop_source stop = {};  ///< told when it is not wanted any more
  };

  /// @param limits of these threads. @param waiting works at a time, those under way included.
  /// @param waiting_of_one of them, of one asker.
  AnswerThreads(ThreadLimits limits, std::size_t waiting, std::size_t waiting_of_one);
  /// Tells the works under way to stop and waits for them; those that wait are forgotten.
  ~AnswerThreads();
  AnswerThreads(const AnswerThreads&) = delete;
  AnswerThreads& operator=(const AnswerThreads&) = delete;

  /// @return false when too many wait already.
  bool add(std::shared_ptr<Work> work);
  /// It is not wanted any more: forgotten where it waits, told to stop where it is under way.
  void drop(const std::shared_ptr<Work>& work);

 private:
  using Works = std::list<std::shared_ptr<Work>>;
  struct Turn {
    std::size_t works = 0, under_way = 0;
    std::uint64_t last = 0;  // when one of theirs was begun
  };

  void run();
  Works::iterator next() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void forget(const Work& work) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const ThreadLimits limits_;
  const std::size_t waiting_limit_, waiting_of_one_;
  base::Mutex mutex_;
  std::condition_variable_any changed_;
  Works waiting_ ABSL_GUARDED_BY(mutex_);
  Works under_way_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, Turn> turns_ ABSL_GUARDED_BY(mutex_);  // of the askers with works
  std::uint64_t begun_ ABSL_GUARDED_BY(mutex_) = 0;
  bool ending_ ABSL_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;  // last: they use all of the others
};

}  // namespace affskel::http

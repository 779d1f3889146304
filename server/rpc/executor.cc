#include "rpc/executor.h"
#include "base/mutex.h"

#include <utility>

namespace affskel::server {

Executor::Executor(const ExecutorOptions& options) {
  try {
    for (std::size_t i = 0; i < options.threads; ++i) threads_.emplace_back([this] { run(); });
  } catch (...) {
    stop();
    throw;
  }
}

Executor::~Executor() {
  stop();
}

void Executor::post(std::uint64_t caller, std::function<void()> body) {
  {
    base::MutexLock lock(mutex_);
    if (stopping_) {
      lock.unlock();
      body();
      return;
    }
    Queue& queue = queues_[caller];
    queue.push_back(std::move(body));
    if (queue.size() == 1) {
      try {
        turns_.push_back(caller);
      } catch (...) {
        queues_.erase(caller);  // without a turn it would wait for ever
        throw;
      }
    }
  }
  changed_.notify_one();
}

void Executor::stop() {
  {
    const base::MutexLock lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  for (std::thread& thread : threads_) {
    if (thread.joinable()) thread.join();
  }
}

void Executor::run() {
  base::MutexLock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] {
      mutex_.assert_held();
      return stopping_ || !turns_.empty();
    });
    if (turns_.empty()) return;
    {
      const std::function<void()> body = take();
      lock.unlock();
      body();
    }
    lock.lock();
  }
}

/// The next body of whose turn it is; its caller goes to the end of the row.
std::function<void()> Executor::take() {
  const std::uint64_t caller = turns_.front();
  turns_.pop_front();
  const auto found = queues_.find(caller);
  std::function<void()> body = std::move(found->second.front());
  found->second.pop_front();
  if (found->second.empty()) {
    queues_.erase(found);
  } else {
    turns_.push_back(caller);
  }
  return body;
}

}  // namespace affskel::server

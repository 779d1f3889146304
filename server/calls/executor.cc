#include "calls/executor.h"
#include "base/mutex.h"

#include <utility>

namespace affskel::server {

Executor::Executor(const ExecutorOptions& options) : options_(options) {
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

std::uint64_t Executor::post(std::uint64_t caller, std::function<void()> body) {
  std::uint64_t number = 0;
  {
    base::MutexLock lock(mutex_);
    number = next_++;
    if (stopping_) {
      lock.unlock();
      body();
      return number;
    }
    Queue& queue = queues_[caller];
    try {
      queue.emplace(number, std::move(body));
      if (queue.size() == 1) turns_.push_back(caller);
    } catch (...) {
      queue.erase(number);
      if (queue.empty()) queues_.erase(caller);  // without a turn it would wait for ever
      throw;
    }
    ++waiting_;
  }
  changed_.notify_one();
  return number;
}

bool Executor::has_room(std::uint64_t caller) const {
  const base::MutexLock lock(mutex_);
  if (waiting_ < options_.calls) return true;
  const auto own = queues_.find(caller);
  return own == queues_.end() || own->second.size() < options_.calls / queues_.size();
}

bool Executor::drop(std::uint64_t caller, std::uint64_t body) {
  std::function<void()> dropped;  // destroyed when the lock is gone
  const base::MutexLock lock(mutex_);
  const auto queue = queues_.find(caller);
  if (queue == queues_.end()) return false;
  const auto found = queue->second.find(body);
  if (found == queue->second.end()) return false;
  dropped = std::move(found->second);
  queue->second.erase(found);
  --waiting_;
  if (!queue->second.empty()) return true;
  queues_.erase(queue);
  std::erase(turns_, caller);
  return true;
}

std::size_t Executor::waiting() const {
  const base::MutexLock lock(mutex_);
  return waiting_;
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
  const auto queue = queues_.find(caller);
  const auto first = queue->second.begin();
  std::function<void()> body = std::move(first->second);
  queue->second.erase(first);
  --waiting_;
  if (queue->second.empty()) {
    queues_.erase(queue);
  } else {
    turns_.push_back(caller);
  }
  return body;
}

}  // namespace affskel::server

#include "http/answer_threads.h"

#include <algorithm>
#include <utility>

namespace affskel::http {

AnswerThreads::AnswerThreads(ThreadLimits limits, std::size_t waiting, std::size_t waiting_of_one)
    : limits_(limits), waiting_limit_(waiting), waiting_of_one_(waiting_of_one) {
  for (std::size_t i = 0; i < limits.threads; ++i) threads_.emplace_back([this] { run(); });
}

AnswerThreads::~AnswerThreads() {
  Works under_way;
  {
    const base::MutexLock lock(mutex_);
    ending_ = true;
    under_way = under_way_;
  }
  for (const auto& work : under_way) work->stop.request_stop();
  changed_.notify_all();
  for (std::thread& thread : threads_) thread.join();
}

bool AnswerThreads::add(std::shared_ptr<Work> work) {
  const base::MutexLock lock(mutex_);
  const auto own = turns_.find(work->whose);
  if (waiting_.size() + under_way_.size() >= waiting_limit_ ||
      (own != turns_.end() && own->second.works >= waiting_of_one_))
    return false;
  ++turns_[work->whose].works;
  waiting_.push_back(std::move(work));
  changed_.notify_one();
  return true;
}

void AnswerThreads::drop(const std::shared_ptr<Work>& work) {
  work->stop.request_stop();
  const base::MutexLock lock(mutex_);
  const auto place = std::find(waiting_.begin(), waiting_.end(), work);
  if (place == waiting_.end()) return;
  waiting_.erase(place);
  forget(*work);
}

void AnswerThreads::forget(const Work& work) {
  const auto own = turns_.find(work.whose);
  if (--own->second.works == 0) turns_.erase(own);
}

// Of the askers with the fewest under way, the one whose turn was longest ago.
AnswerThreads::Works::iterator AnswerThreads::next() {
  auto found = waiting_.end();
  std::pair<std::size_t, std::uint64_t> best;
  for (auto work = waiting_.begin(); work != waiting_.end(); ++work) {
    const Turn& turn = turns_.at((*work)->whose);
    const auto order = std::make_pair(turn.under_way, turn.last);
    if (turn.under_way >= limits_.of_one || (found != waiting_.end() && order >= best)) continue;
    found = work;
    best = order;
  }
  return found;
}

void AnswerThreads::run() {
  base::MutexLock lock(mutex_);
  while (!ending_) {
    const auto chosen = next();
    if (chosen == waiting_.end()) {
      changed_.wait(lock);
      continue;
    }
    under_way_.splice(under_way_.end(), waiting_, chosen);
    Turn& turn = turns_.at((*chosen)->whose);
    ++turn.under_way;
    turn.last = ++begun_;
    lock.unlock();
    (*chosen)->run();
    lock.lock();
    --turn.under_way;
    forget(**chosen);
    std::shared_ptr<Work> ended = std::move(*chosen);
    under_way_.erase(chosen);
    lock.unlock();
    ended.reset();
    lock.lock();
  }
}

}  // namespace affskel::http

#include "scheduling/lease_queue.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <string>

#include "base/mutex.h"
#include "calls/call_timer.h"
#include "calls/status.h"

namespace affskel::server {
namespace {

using Time = std::chrono::steady_clock::time_point;

constexpr std::uint32_t kMaxWaitMs = 30000;
constexpr std::size_t kMaxTogether = 64;  // polls in a transaction

}  // namespace

/// One waiting call.
class LeaseQueue::Poll final : public grpc::ServerUnaryReactor,
                               public Endable,
                               public std::enable_shared_from_this<Poll> {
 public:
  Poll(LeaseQueue& queue, grpc::CallbackServerContext* context, const v1::LeaseTaskRequest& request,
       v1::LeaseTaskResponse* response)
      : queue_(queue),
        context_(context),
        request_(request),
        response_(response),
        timer_(queue.room_.metrics, Method::kLeaseTask),
        deadline_(std::chrono::steady_clock::now() +
                  std::chrono::milliseconds(std::min(request.wait_ms(), kMaxWaitMs))) {}

  const v1::LeaseTaskRequest& request() const { return request_; }
  Time deadline() const { return deadline_; }

  /// Takes a place among the calls that wait.  @throws CallEnded.
  void enter() {
    scope_.emplace(queue_.room_, *context_, Method::kLeaseTask);
    place_ = queue_.room_.polls.enter(scope_->caller(), weak_from_this());
  }

  /// Others need the place, or the peer does not take the answer.
  void end(const grpc::Status& status) override {
    queue_.remove(shared_from_this());
    if (answer(status)) return;
    const base::MutexLock lock(mutex_);
    if (!done_) context_->TryCancel();
  }

  /// Ends the call unless it has ended; false when it had.
  bool answer(const grpc::Status& status, std::optional<v1::Lease> lease = std::nullopt) {
    const base::MutexLock lock(mutex_);
    if (ended_) return false;
    ended_ = true;
    if (lease) {
      token_ = lease->token();
      *response_->mutable_lease() = *std::move(lease);
    }
    if (scope_) {
      unread_.emplace(queue_.room_.answers.enter(
          scope_->caller(), response_->SpaceUsedLong() + response_->ByteSizeLong(), weak_from_this()));
    }
    timer_.ended(status);
    Finish(status);
    return true;
  }

  void OnCancel() override { end(grpc::Status::CANCELLED); }  // never after OnDone

  void OnDone() override {
    // A lease whose answer did not reach the worker would lie idle until its deadline.
    if (!token_.empty() && context_->IsCancelled()) {
      queue_.registry_.ended(token_);
      queue_.room_.worker_calls.post(scope_->caller().connection, [&store = queue_.store_, token = token_] {
        guarded([&] { store.give_back(token); });
      });
    }
    place_.leave();
    unread_.reset();
    const PollPtr self = std::move(self_);  // the last use of this object
    const base::MutexLock lock(mutex_);
    done_ = true;
  }

  /// Keeps the object alive until OnDone.
  void hold(const PollPtr& self) { self_ = self; }

  bool fresh = true;  // not tried yet; guarded by the queue's lock

 private:
  LeaseQueue& queue_;
  grpc::CallbackServerContext* context_;
  const v1::LeaseTaskRequest request_;
  v1::LeaseTaskResponse* response_;
  const CallTimer timer_;
  const Time deadline_;
  base::Mutex mutex_;
  bool ended_ = false;
  bool done_ = false;  // with the context, too
  std::string token_;
  std::optional<CallScope> scope_;
  CallLimit::Place place_;
  std::optional<Answers::Answer> unread_;
  PollPtr self_;
};

LeaseQueue::LeaseQueue(Store& store, WorkerRegistry& registry, BoundsExchange& bounds, CallRoom& room)
    : store_(store), registry_(registry), bounds_(bounds), room_(room), thread_([this] { run(); }) {}

LeaseQueue::~LeaseQueue() {
  stop();
}

grpc::ServerUnaryReactor* LeaseQueue::lease(grpc::CallbackServerContext* context,
                                            const v1::LeaseTaskRequest* request,
                                            v1::LeaseTaskResponse* response) {
  const auto poll = std::make_shared<Poll>(*this, context, *request, response);
  poll->hold(poll);
  // Before the registry: a worker without an identity must not fill the list of workers.
  grpc::Status status = guarded([&] {
    poll->enter();
    check_worker(request->worker());
  });
  if (status.ok()) {
    // The worker is seen with its call in line: who finds it in the list of workers may count on its being served.
    const base::MutexLock lock(mutex_);
    registry_.seen(request->worker(), std::min(request->wait_ms(), kMaxWaitMs));
    if (stopping_) {
      status = shutting_down();
    } else {
      waiting_.push_back(poll);
    }
  }
  if (!status.ok()) poll->answer(status);
  changed_.notify_all();
  return poll.get();
}

void LeaseQueue::on_work() {
  {
    const base::MutexLock lock(mutex_);
    work_ = true;
  }
  changed_.notify_all();
}

void LeaseQueue::stop() {
  std::list<PollPtr> waiting;
  {
    const base::MutexLock lock(mutex_);
    stopping_ = true;
    waiting.swap(waiting_);
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  for (const PollPtr& poll : waiting) poll->answer(shutting_down());
}

void LeaseQueue::remove(const PollPtr& poll) {
  const base::MutexLock lock(mutex_);
  waiting_.remove(poll);
}

void LeaseQueue::run() {
  base::MutexLock lock(mutex_);
  while (!stopping_) {
    std::list<PollPtr> candidates;
    for (const PollPtr& poll : waiting_) {
      if (work_ || poll->fresh) candidates.push_back(poll);
      poll->fresh = false;
    }
    work_ = false;
    lock.unlock();
    put_holders_first(candidates);
    serve(std::move(candidates));
    end_expired();
    lock.lock();
    const auto something_to_do = [this] {
      mutex_.assert_held();
      return stopping_ || work_ ||
             std::any_of(waiting_.begin(), waiting_.end(), [](const PollPtr& poll) { return poll->fresh; });
    };
    if (waiting_.empty()) {
      changed_.wait(lock, something_to_do);
      continue;
    }
    const auto first =
        std::min_element(waiting_.begin(), waiting_.end(),
                         [](const PollPtr& a, const PollPtr& b) { return a->deadline() < b->deadline(); });
    const Time deadline = (*first)->deadline();
    changed_.wait_until(lock, deadline, something_to_do);
  }
}

// Another would fetch the job and make it ready first, and what is derived have to begin with the field.
void LeaseQueue::put_holders_first(std::list<PollPtr>& polls) {
  if (polls.size() < 2) return;
  std::set<std::string> jobs;
  guarded([&] { jobs = store_.requested_jobs(); });
  if (jobs.empty()) return;
  const auto holds = [&](const PollPtr& poll) {
    const v1::LeaseTaskRequest& request = poll->request();
    return jobs.contains(request.preferred_job()) ? 1 + int{request.derived()} : 0;
  };
  polls.sort([&](const PollPtr& a, const PollPtr& b) { return holds(a) > holds(b); });
}

void LeaseQueue::serve(std::list<PollPtr> polls) {
  while (!polls.empty()) {
    std::vector<PollPtr> together;
    {
      const base::MutexLock lock(mutex_);
      if (stopping_) return;
      for (; !polls.empty() && together.size() < kMaxTogether; polls.pop_front()) {
        const PollPtr& poll = polls.front();
        if (std::find(waiting_.begin(), waiting_.end(), poll) != waiting_.end()) together.push_back(poll);
      }
    }
    serve_together(together);
  }
}

/// Several in one transaction, so that a hundred workers do not wait for the disk a hundred times.
void LeaseQueue::serve_together(const std::vector<PollPtr>& polls) {
  std::vector<Store::LeaseAsk> asks;
  for (const PollPtr& poll : polls) {
    const v1::LeaseTaskRequest& request = poll->request();
    asks.push_back({request.worker(),
                    request.preferred_job(),
                    registry_.is_supervised(request.worker()),
                    {request.held().begin(), request.held().end()}});
  }
  std::vector<Store::LeaseAnswer> answers;
  const grpc::Status status = guarded([&] { answers = store_.lease_all(asks); });
  for (std::size_t i = 0; i < polls.size(); ++i) {
    if (!status.ok()) {
      end_poll(polls[i], status);
    } else if (answers[i].refused) {
      end_poll(polls[i], guarded([&] { std::rethrow_exception(answers[i].refused); }));
    } else if (answers[i].lease) {
      hand_over(polls[i], *std::move(answers[i].lease));
    }
  }
}

void LeaseQueue::end_poll(const PollPtr& poll, const grpc::Status& status) {
  remove(poll);
  poll->answer(status);
}

void LeaseQueue::hand_over(const PollPtr& poll, v1::Lease lease) {
  remove(poll);
  registry_.granted(poll->request().worker(), lease);
  if (lease.kind() == v1::TASK_KIND_ERODE) bounds_.join(lease.field(), poll->request().worker().id());
  const std::string token = lease.token();
  if (poll->answer(grpc::Status::OK, std::move(lease))) return;
  registry_.ended(token);
  guarded([&] { store_.give_back(token); });
}

void LeaseQueue::end_expired() {
  std::list<PollPtr> expired;
  {
    const base::MutexLock lock(mutex_);
    const Time now = std::chrono::steady_clock::now();
    for (auto poll = waiting_.begin(); poll != waiting_.end();) {
      const auto next = std::next(poll);
      if ((*poll)->deadline() <= now && !(*poll)->fresh) expired.splice(expired.end(), waiting_, poll);
      poll = next;
    }
  }
  for (const PollPtr& poll : expired) poll->answer(grpc::Status::OK);
}

}  // namespace affskel::server

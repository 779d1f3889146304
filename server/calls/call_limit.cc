#include "calls/call_limit.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "base/logfmt.h"
#include "base/mutex.h"
#include "calls/status.h"

namespace affskel::server {
namespace {

// Waiting for a turn costs little, but not nothing.
constexpr std::size_t kWaitersPerPlace = 16;

// A call that, at its present pace, could send all it holds again within this time is not ended for memory.
constexpr double kRelieveSeconds = 60;

// Between two lines of the log that say how many calls were ended.
constexpr std::chrono::seconds kLogEvery{10};

const auto by_peer = [](const Caller& caller) { return caller.peer; };
const auto by_connection = [](const Caller& caller) { return caller.connection; };

void run(const std::vector<std::function<void()>>& later) {
  for (const auto& one : later) one();
}

}  // namespace

CallLimit::CallLimit(CallLimitOptions options) : options_(std::move(options)), log_(kLogEvery) {}

CallLimit::Place::Place(Place&& other) noexcept
    : limit_(std::exchange(other.limit_, nullptr)), number_(other.number_) {}

CallLimit::Place& CallLimit::Place::operator=(Place&& other) noexcept {
  if (this != &other) {
    leave();
    limit_ = std::exchange(other.limit_, nullptr);
    number_ = other.number_;
  }
  return *this;
}

void CallLimit::Place::leave() {
  if (limit_ == nullptr) return;
  CallLimit& limit = *std::exchange(limit_, nullptr);
  Later later;
  {
    const base::MutexLock lock(limit.mutex_);
    if (limit.holders_.erase(number_) == 0) return;  // it had gone to another
    limit.serve_waiters(later);
  }
  run(later);
}

void CallLimit::Place::turn() {
  if (limit_ == nullptr) return;
  const base::MutexLock lock(limit_->mutex_);
  const auto holder = limit_->holders_.find(number_);
  if (holder != limit_->holders_.end()) holder->second.pace.turn(limit_->options_.now());
}

void CallLimit::Place::moved(std::uint64_t bytes) {
  if (limit_ == nullptr) return;
  const base::MutexLock lock(limit_->mutex_);
  const auto holder = limit_->holders_.find(number_);
  if (holder != limit_->holders_.end()) holder->second.pace.moved(bytes, limit_->options_.now());
}

CallLimit::Place CallLimit::enter(const Caller& caller, std::weak_ptr<Endable> call) {
  Later later;
  std::optional<Place> place;
  grpc::Status refused;
  {
    const base::MutexLock lock(mutex_);
    place = try_enter(caller, call, later);
    if (!place) refused = refusal(caller);
  }
  run(later);
  if (!place) throw CallEnded(refused);
  return *std::move(place);
}

void CallLimit::enter_later(const Caller& caller, std::weak_ptr<Endable> call, Granted granted) {
  Later later;
  std::optional<Place> place;
  grpc::Status refused;
  {
    const base::MutexLock lock(mutex_);
    place = try_enter(caller, call, later);
    if (!place && !closed_ && options_.patience.count() > 0 &&
        waiters_.size() < kWaitersPerPlace * options_.most) {
      waiters_.push_back({caller, std::move(call), std::move(granted), options_.now() + options_.patience});
      return;
    }
    if (!place) refused = refusal(caller);
  }
  run(later);
  granted(refused, place ? *std::move(place) : Place());
}

std::optional<CallLimit::Place> CallLimit::try_enter(const Caller& caller, const std::weak_ptr<Endable>& call,
                                                     Later& later) {
  if (closed_) return std::nullopt;
  if (options_.half_for_a_peer && of_peer(caller.peer) >= std::max<std::size_t>(1, options_.most / 2)) {
    return std::nullopt;
  }
  const base::Pace::Time now = options_.now();
  if (holders_.size() >= options_.most && !make_room(caller, now, later)) return std::nullopt;
  const std::uint64_t number = next_number_++;
  holders_.emplace(number,
                   Holder{caller, call, base::Pace(options_.pace.value_or(base::PaceOptions{})), now});
  return Place(this, number);
}

/// Takes a place from a call that has less right to it than this caller's next one.
bool CallLimit::make_room(const Caller& caller, base::Pace::Time now, Later& later) {
  if (options_.pace) {
    const auto slow = slowest(now, [&](const Holder& holder) { return holder.pace.slow(now); });
    if (slow != holders_.end()) {
      evict(slow, "others need its place, and it was too slow", later);
      return true;
    }
  }
  return take_from(by_peer, options_.most / 2, caller, "peer", later) ||
         take_from(by_connection, std::max<std::size_t>(1, options_.most / 8), caller, "connection", later);
}

/// Takes a place from a peer or connection with more than its share, if this caller has less.
template <typename Key>
bool CallLimit::take_from(Key key, std::size_t share, const Caller& caller, const char* who, Later& later) {
  std::map<decltype(key(caller)), std::size_t> counts;
  for (const auto& [number, holder] : holders_) ++counts[key(holder.caller)];
  if (counts[key(caller)] >= share) return false;
  const auto found =
      slowest(options_.now(), [&](const Holder& holder) { return counts[key(holder.caller)] > share; });
  if (found == holders_.end()) return false;
  evict(found, std::string("others need its place, and its ") + who + " holds more than its share", later);
  return true;
}

/// The slowest of the calls that can be ended and for which belongs(holder) holds.
template <typename Belongs>
CallLimit::Holders::iterator CallLimit::slowest(base::Pace::Time now, Belongs belongs) {
  const auto worse = [&](const Holder& a, const Holder& b) {
    const double one = a.pace.rate(now), other = b.pace.rate(now);
    return one != other ? one < other : a.entered < b.entered;
  };
  auto found = holders_.end();
  for (auto holder = holders_.begin(); holder != holders_.end(); ++holder) {
    const Holder& candidate = holder->second;
    // One that works, and does not wait for its peer, is about to end by itself.
    if (candidate.call.expired() || (options_.pace && !candidate.pace.waiting())) continue;
    if (!belongs(candidate)) continue;
    if (found == holders_.end() || worse(candidate, found->second)) found = holder;
  }
  return found;
}

void CallLimit::evict(Holders::iterator holder, const std::string& why, Later& later) {
  log_eviction(holder->second, why);
  later.push_back(
      [call = holder->second.call,
       status = grpc::Status(grpc::StatusCode::UNAVAILABLE, "the call was ended: " + why + "; try again")] {
        if (const auto alive = call.lock()) alive->end(status);
      });
  holders_.erase(holder);
}

void CallLimit::log_eviction(const Holder& holder, const std::string& why) {
  const auto number = log_.happened(options_.now());
  if (!number) return;
  spdlog::warn(base::logfmt("call_ended", {{"number", *number},
                                           {"kind", options_.what},
                                           {"peer", holder.caller.peer},
                                           {"owner", holder.caller.identity.owner},
                                           {"bytes", holder.pace.total()},
                                           {"message", why}}));
}

std::size_t CallLimit::of_peer(const std::string& peer) const {
  return static_cast<std::size_t>(std::count_if(
      holders_.begin(), holders_.end(), [&](const auto& entry) { return entry.second.caller.peer == peer; }));
}

/// Gives free places to the waiters, in the order of their coming.
void CallLimit::serve_waiters(Later& later) {
  while (!waiters_.empty() && holders_.size() < options_.most) {
    Waiter waiter = std::move(waiters_.front());
    waiters_.pop_front();
    if (waiter.call.expired()) continue;
    std::optional<Place> place = try_enter(waiter.caller, waiter.call, later);
    const grpc::Status status = place ? grpc::Status::OK : refusal(waiter.caller);
    // A function must be copyable, a place is not.
    auto shared = std::make_shared<Place>(place ? *std::move(place) : Place());
    later.push_back(
        [granted = std::move(waiter.granted), status, shared] { granted(status, std::move(*shared)); });
  }
}

void CallLimit::tick() {
  Later later;
  {
    const base::MutexLock lock(mutex_);
    const base::Pace::Time now = options_.now();
    for (auto holder = holders_.begin(); options_.pace && holder != holders_.end();) {
      const auto next = std::next(holder);
      if (holder->second.pace.late(now) && !holder->second.call.expired()) {
        evict(holder, "its peer sent or took too little for too long", later);
      }
      holder = next;
    }
    serve_waiters(later);
    for (auto waiter = waiters_.begin(); waiter != waiters_.end();) {
      const auto next = std::next(waiter);
      if (waiter->until <= now || waiter->call.expired()) {
        later.push_back([granted = std::move(waiter->granted), status = refusal(waiter->caller)] {
          granted(status, Place());
        });
        waiters_.erase(waiter);
      }
      waiter = next;
    }
  }
  run(later);
}

bool CallLimit::relieve() {
  Later later;
  {
    const base::MutexLock lock(mutex_);
    const base::Pace::Time now = options_.now();
    const auto seconds = [&](const Holder& holder) {
      const bool judged = holder.pace.judged(now) && !holder.call.expired();
      return judged ? static_cast<double>(holder.pace.total()) / (holder.pace.rate(now) + 1) : 0.0;
    };
    const auto worst = std::max_element(holders_.begin(), holders_.end(), [&](const auto& a, const auto& b) {
      return seconds(a.second) < seconds(b.second);
    });
    if (worst == holders_.end() || seconds(worst->second) < kRelieveSeconds) return false;
    evict(worst, "others need the memory, and it was too slow for what it holds", later);
  }
  run(later);
  return true;
}

void CallLimit::close(const grpc::Status& why) {
  std::list<Waiter> waiters;
  {
    const base::MutexLock lock(mutex_);
    closed_ = why;
    waiters.swap(waiters_);
  }
  for (const Waiter& waiter : waiters) waiter.granted(why, Place());
}

void CallLimit::end_all(const grpc::Status& why) {
  end_calls(why, [](const Caller&) { return true; });
}

void CallLimit::end_of_token(std::int64_t token, const grpc::Status& why) {
  end_calls(why, [token](const Caller& caller) { return caller.identity.token == token; });
}

void CallLimit::end_calls(const grpc::Status& why, const std::function<bool(const Caller&)>& which) {
  std::vector<std::weak_ptr<Endable>> calls;
  {
    const base::MutexLock lock(mutex_);
    for (const auto& [number, holder] : holders_) {
      if (which(holder.caller)) calls.push_back(holder.call);
    }
    for (const Waiter& waiter : waiters_) {
      if (which(waiter.caller)) calls.push_back(waiter.call);
    }
  }
  for (const auto& call : calls) {
    if (const auto alive = call.lock()) alive->end(why);
  }
}

std::size_t CallLimit::used() const {
  const base::MutexLock lock(mutex_);
  return holders_.size();
}

grpc::Status CallLimit::refusal(const Caller& caller) const {
  if (closed_) return *closed_;
  const auto number = [](std::size_t count) { return std::to_string(count); };
  if (options_.half_for_a_peer && holders_.size() < options_.most) {
    return {options_.refusal, number(of_peer(caller.peer)) + " " + options_.what +
                                  " of yours are under way, the most that one peer may have here; try again"};
  }
  return {options_.refusal, number(holders_.size()) + " " + options_.what + " are under way, and " +
                                number(options_.most) +
                                " are the most that this server has at once; try again"};
}

}  // namespace affskel::server

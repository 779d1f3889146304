#pragma once

#include <grpcpp/support/status.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/mutex.h"
#include "base/pace.h"
#include "traffic/caller.h"
#include "traffic/rare_log.h"

namespace affskel::server {

/// A call that can be ended from outside.
class Endable {
 public:
  virtual ~Endable() = default;
  /// Ends the call unless it has ended; from any thread, returns at once.
  virtual void end(const grpc::Status& status) = 0;
};

struct CallLimitOptions {
  std::string what;  ///< the calls, plural, for messages
  std::size_t most = 1;
  bool half_for_a_peer = false;           ///< no peer has more than half of the places, ever
  std::chrono::milliseconds patience{0};  ///< how long a call waits for its turn
  std::optional<base::PaceOptions> pace;  ///< none: calls are never too slow
  grpc::StatusCode refusal = grpc::StatusCode::UNAVAILABLE;
  std::function<base::Pace::Time()> now = [] { return std::chrono::steady_clock::now(); };
};

/// Bounds the calls of one kind.  Any call may take a free place.  When none is free, a new call takes the
/// place of the first of these that there is: a call whose peer is slower than the least rate; a call of the
/// peer that holds more than half of the places, if its own peer holds less; a call of the connection that
/// holds more than an eighth, if its own holds less.  So neither one peer nor one connection keeps others
/// out, and none is held back while there is room.  Thread-safe.
class CallLimit {
 public:
  explicit CallLimit(CallLimitOptions options);
  CallLimit(const CallLimit&) = delete;
  CallLimit& operator=(const CallLimit&) = delete;

  /// The place of one call, until it is destroyed; used by one thread at a time.
  class Place {
   public:
    Place() = default;
    Place(Place&& other) noexcept;
    Place& operator=(Place&& other) noexcept;
    ~Place() { leave(); }

    explicit operator bool() const { return limit_ != nullptr; }
    /// From now on the call waits for its peer.
    void turn();
    /// The peer has sent or taken a message.
    void moved(std::uint64_t bytes);
    void leave();

   private:
    friend class CallLimit;
    Place(CallLimit* limit, std::uint64_t number) : limit_(limit), number_(number) {}
    CallLimit* limit_ = nullptr;
    std::uint64_t number_ = 0;
  };

  /// Hears that the place is there, or why there is none.  Called once, by any thread; must return quickly.
  using Granted = std::function<void(const grpc::Status&, Place)>;

  /// @param call is ended when its place goes to another, or its peer is late; empty: it never is.
  /// @throws CallEnded with the refusal, naming limit and use.
  Place enter(const Caller& caller, std::weak_ptr<Endable> call);

  /// As enter, but waits for a turn as long as patience lasts.  May call `granted` before it returns.
  void enter_later(const Caller& caller, std::weak_ptr<Endable> call, Granted granted);

  /// Ends the calls whose peers are late, and refuses waiters that have waited too long.  Call now and then.
  void tick();

  /// When memory is short: ends the call that, at its present pace, takes longest to bring what it holds
  /// once more, if that is over a minute.  False when there is none.
  bool relieve();

  /// Refuses all that come from now on, and the waiters.
  void close(const grpc::Status& why);

  /// Ends all calls under way.
  void end_all(const grpc::Status& why);

  /// Ends those of this token's holder.
  void end_of_token(std::int64_t token, const grpc::Status& why);

  /// Calls under way, and as many as there may be.
  std::size_t used() const;
  std::size_t most() const { return options_.most; }

 private:
  struct Holder {
    Caller caller;
    std::weak_ptr<Endable> call;
    base::Pace pace;
    base::Pace::Time entered;
  };
  struct Waiter {
    Caller caller;
    std::weak_ptr<Endable> call;
    Granted granted;
    base::Pace::Time until;
  };
  using Holders = std::map<std::uint64_t, Holder>;  // by the order of their coming
  /// What is to be done when the lock is gone.
  using Later = std::vector<std::function<void()>>;

  std::optional<Place> try_enter(const Caller& caller, const std::weak_ptr<Endable>& call, Later& later)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool make_room(const Caller& caller, base::Pace::Time now, Later& later)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void evict(Holders::iterator holder, const std::string& why, Later& later)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void log_eviction(const Holder& holder, const std::string& why);
  template <typename Belongs>
  Holders::iterator slowest(base::Pace::Time now, Belongs belongs) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  template <typename Key>
  bool take_from(Key key, std::size_t share, const Caller& caller, const char* who, Later& later)
      ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void end_calls(const grpc::Status& why, const std::function<bool(const Caller&)>& which);
  std::size_t of_peer(const std::string& peer) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void serve_waiters(Later& later) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  grpc::Status refusal(const Caller& caller) const ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const CallLimitOptions options_;
  mutable base::Mutex mutex_;
  Holders holders_ ABSL_GUARDED_BY(mutex_);
  std::list<Waiter> waiters_ ABSL_GUARDED_BY(mutex_);
  std::uint64_t next_number_ ABSL_GUARDED_BY(mutex_) = 1;
  std::optional<grpc::Status> closed_ ABSL_GUARDED_BY(mutex_);
  RareLog log_;
};

}  // namespace affskel::server

#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "base/mutex.h"
#include "client/web/random_key.h"

namespace affskel::client {

/// When the brake grips, and how hard.
struct BrakeLimits {
  unsigned free = 5;                        ///< wrong tokens from one address that cost nothing
  unsigned free_in_all = 100;               ///< and from all
  std::chrono::milliseconds forget{60000};  ///< one of them is forgotten after this
  /// Between looks at tokens from one address: doubles from the first to the longest with every wrong one.
  std::chrono::milliseconds first{250}, longest{2000};
  std::chrono::milliseconds longest_in_all{100};
  std::chrono::milliseconds again{1000};        ///< a token that is put off may come again after this
  std::chrono::milliseconds wrong{10000};       ///< one that was wrong, after this
  std::size_t addresses = 1024, tokens = 4096;  ///< that are remembered
};

/// Slows down the guessing of tokens: nothing waits, what comes too early is put off.
///
/// From an address that showed too many wrong tokens one is looked at only when it comes a second time, and
/// then seldom.  So a guesser, who tries one after the other, is hardly ever looked at, and a user behind the
/// same address, who comes again as told, is.  A token that was right once is always looked at.  Keeps no
/// tokens, only hashes with a secret salt.  Thread-safe.
class SignInBrake {
 public:
  using Clock = std::chrono::steady_clock;

  explicit SignInBrake(BrakeLimits limits = {}, std::function<Clock::time_point()> now = Clock::now)
      : limits_(limits), now_(std::move(now)) {}

  /// @param peer see http::peer_key.
  /// @return after which time it may come again; nothing when it may be looked at now, which is to be
  ///   followed by one of the next three.
  std::optional<Clock::duration> put_off(const std::string& peer, const std::string& token);
  void was_right(const std::string& peer, const std::string& token);
  void was_wrong(const std::string& token);
  /// It could not be looked at.
  void was_not_seen(const std::string& peer);

 private:
  struct Tries {
    unsigned wrong = 0;  // and those that are being looked at
    Clock::time_point last{}, next{};
  };

  std::string hash(const std::string& token) const;
  void forget_old(Tries& tries, Clock::time_point now) const;
  Tries& tries_of(const std::string& peer) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void take_back(const std::string& peer) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const BrakeLimits limits_;
  const std::function<Clock::time_point()> now_;
  const std::string salt_ = random_key();
  base::Mutex mutex_;
  Tries all_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, Tries> of_peer_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, Clock::time_point> again_ ABSL_GUARDED_BY(mutex_);  // by hash
  std::set<std::string> right_ ABSL_GUARDED_BY(mutex_);                     // hashes
};

}  // namespace affskel::client

#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "base/memory_file.h"
#include "base/mutex.h"

namespace affskel::client {

/// A user of the page.
struct WebUser {
  std::shared_ptr<const base::MemoryFile>
      token;          ///< passed on with every call; null = the client's own identity
  std::string owner;  ///< of the jobs that are theirs; empty = all are
  bool admin = false;
  std::uint64_t max_mesh_bytes = 0;  ///< largest upload, as the server takes it
};

/// How many people at a time, and for how long.
struct SessionLimits {
  std::size_t sessions = 1024;
  std::size_t of_owner = 16;           ///< one more ends the owner's longest unused
  std::chrono::hours idle{12};         ///< ends a session that is not used
  std::chrono::hours longest{7 * 24};  ///< ends every session
};

/// The people who signed in, by the secret of their cookie, of which only the hash is kept.  Thread-safe.
class WebSessions {
 public:
  using Clock = std::chrono::steady_clock;

  /// A session that was found.
  struct Found {
    std::string id;  ///< names it; not its secret
    WebUser user;
  };

  explicit WebSessions(SessionLimits limits = {}, std::function<Clock::time_point()> now = Clock::now)
      : limits_(limits), now_(std::move(now)) {}

  /// @return the secret for the cookie; nothing when there are too many sessions.
  std::optional<std::string> begin(const WebUser& user);
  /// Counts as a use.
  std::optional<Found> find(const std::string& secret);
  void end(const std::string& id);

  /// A key that begins one session of this machine's user: for addresses that are printed or opened.
  std::string new_key();
  /// Whether it is such a key and was not used before; it is used then.
  bool use_key(const std::string& key);
  /// What such a key was used for did not come about: it may be used again.
  void give_back(const std::string& key);

 private:
  struct Session {
    WebUser user;
    Clock::time_point begun, used;
  };
  void drop_old() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void make_room(const std::string& owner) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);

  const SessionLimits limits_;
  const std::function<Clock::time_point()> now_;
  base::Mutex mutex_;
  std::map<std::string, Session> sessions_ ABSL_GUARDED_BY(mutex_);  // by the secret's SHA-256
  std::set<std::string> keys_ ABSL_GUARDED_BY(mutex_);               // unused ones, their SHA-256
};

}  // namespace affskel::client

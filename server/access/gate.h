#pragma once

#include <grpcpp/support/status.h>
#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "access/identity.h"
#include "access/rules.h"
#include "base/mutex.h"

namespace affskel::server {

/// What a call shows of its caller.
struct Credentials {
  std::optional<uid_t> uid;                  ///< the peer's, on a Unix socket
  std::optional<std::string> authorization;  ///< the metadata of this name; absent = none
  bool several_authorizations = false;       ///< there is more than one
  bool has_certificate = false;              ///< the peer has shown a client certificate, and it is good
};

/// Where the gate looks tokens up: in the server's store.
class TokenSource {
 public:
  virtual ~TokenSource() = default;
  /// The row of a token, in whatever state; nothing when it is unknown.
  virtual std::optional<TokenRow> find_token(std::string_view token) = 0;
  /// Whether a token was ever added.
  virtual bool has_tokens() = 0;
  /// Of these ids, those whose tokens are revoked or expired at `now_ms`.
  virtual std::vector<std::int64_t> invalid_tokens(const std::vector<std::int64_t>& ids,
                                                   std::int64_t now_ms) = 0;
  virtual void note_tokens_used(const std::map<std::int64_t, std::int64_t>& last_used_ms) = 0;
};

/// What the gate says: a status, and when that is OK, the caller.
struct Admission {
  grpc::Status status;
  Identity identity;
};

struct GateOptions {
  bool client_certificates = false;      ///< TCP callers must have shown one
  std::function<std::int64_t()> now_ms;  ///< Unix time in milliseconds
};

/// Identifies a caller, and decides whether it may make a call.
///
/// A token identifies its owner, on any transport.  Without one, a caller on a Unix socket is the user
/// whose process it is: the server's own user and root are admins.  A caller on TCP without a token is
/// admitted only by a server that never had any token: then all of them are one admin without a name, to whom
/// no job is another's.  Thread-safe.
class Gate {
 public:
  /// @param tokens must outlive it.
  Gate(TokenSource& tokens, GateOptions options);

  /// The statuses of callers that may not make this call are those of access_rules().
  Admission admit(Method method, const Credentials& credentials);

  /// Tokens that were good when they were used and are no longer: calls under way by them are to end.  Each
  /// is told until a minute after its last use, for calls that were admitted and had not begun.  Call now and then.
  std::vector<std::int64_t> newly_invalid();

  /// Writes down when tokens were last used, a minute after the last time.  Call now and then.
  void note_use();

 private:
  TokenSource& tokens_;
  const GateOptions options_;
  base::Mutex mutex_;
  std::map<std::int64_t, std::int64_t> used_ms_ ABSL_GUARDED_BY(mutex_);  // by token: not written down yet
  std::map<std::int64_t, std::int64_t> active_ ABSL_GUARDED_BY(mutex_);   // by token: last admitted
  std::int64_t noted_ms_ ABSL_GUARDED_BY(mutex_) = 0;
};

/// The name of a user of this machine, "uid:N" when there is none.
std::string user_name(uid_t uid);

}  // namespace affskel::server

#pragma once

#include <stop_token>
#include <string>

#include "base/memory_file.h"
#include "client/connection/environment.h"
#include "client/connection/session.h"
#include "wire/channel.h"

namespace affskel::client {

/// The server behind the page; a private one is started when it is not there.  Thread-safe.
class Backend {
 public:
  /// @param server, access as choose_server takes them.
  Backend(Environment environment, std::string server, wire::AccessFiles access, RetryPolicy policy);

  /// For one request, as the client itself.
  /// @param stop ends it; without one the policy's does.
  Session session(std::stop_token stop = {}) const;
  /// For one request of a user with this token, and never as the client itself.  The token must outlive the
  /// session.
  Session session(const base::MemoryFile& token, std::stop_token stop = {}) const;

  /// Whether the server asks for tokens: it refuses one that it cannot know.
  /// @throws ClientError when it cannot be asked.
  bool refuses_strangers() const;
  /// Whether it refuses the client itself.  @throws ClientError as above.
  bool refuses_us() const;

  const Environment& environment() const { return environment_; }
  /// The name of the client's user.
  std::string own_user() const { return user_name(environment_); }

 private:
  Session session_with(const wire::AccessFiles& access, std::stop_token stop) const;

  const Environment environment_;
  const std::string server_;
  const wire::AccessFiles access_;
  const RetryPolicy policy_;
};

}  // namespace affskel::client

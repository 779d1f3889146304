#pragma once

#include <optional>

#include "client/cli/console.h"
#include "client/commands/options.h"
#include "client/connection/environment.h"
#include "client/connection/session.h"

namespace affskel::client {

/// What every command works with.  The server is looked for when it is first needed.
class Context {
 public:
  Context(Console& console, Environment environment, GlobalOptions global, RetryPolicy policy = {})
      : console_(console),
        environment_(std::move(environment)),
        global_(std::move(global)),
        policy_(policy) {}

  Console& console() { return console_; }
  const Environment& environment() const { return environment_; }

  /// @throws ClientError as choose_server.
  Session& session();

 private:
  Console& console_;
  Environment environment_;
  GlobalOptions global_;
  RetryPolicy policy_;
  std::optional<Session> session_;
};

}  // namespace affskel::client

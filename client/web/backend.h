#pragma once

#include <memory>
#include <sstream>
#include <stop_token>
#include <string>
#include <vector>

#include "base/memory_file.h"
#include "client/commands/shared/context.h"

namespace affskel::client {

/// The server behind the page, as the commands talk to it; a private one is started when it is not there.
/// Thread-safe.
class Backend {
 public:
  /// One request's connection, and what was said in it.
  class Call {
   public:
    Call(const Environment& environment, const GlobalOptions& global, const RetryPolicy& policy);
    Context& context() { return context_; }
    Session& session() { return context_.session(); }
    /// What a command would have warned of.
    std::vector<std::string> warnings() const;

   private:
    std::ostringstream out_, err_;
    Console console_;
    Context context_;
  };

  /// @param global as of the command line: the server, and what is shown to it.
  Backend(Environment environment, GlobalOptions global, RetryPolicy policy);

  /// For one request, as the client itself.
  /// @param stop ends it; without one the policy's does.
  std::unique_ptr<Call> call(std::stop_token stop = {}) const;
  /// For one request of somebody whose token this is, and never as the client itself.  The token must outlive
  /// the call.
  std::unique_ptr<Call> call(const base::MemoryFile& token, std::stop_token stop = {}) const;

  /// Whether the server asks for tokens: it refuses one that nobody can have.
  /// @throws ClientError when it cannot be asked.
  bool refuses_strangers() const;
  /// Whether it refuses the client itself.  @throws ClientError as above.
  bool refuses_us() const;

  /// The name of the client's user.
  std::string own_user() const { return user_name(environment_); }

 private:
  RetryPolicy policy_until(std::stop_token stop) const;

  Environment environment_;
  GlobalOptions global_;
  RetryPolicy policy_;
};

}  // namespace affskel::client

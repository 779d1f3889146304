#include "client/web/backend.h"

#include <utility>

#include "client/base/error.h"
#include "client/web/random_key.h"

namespace affskel::client {
namespace {

bool is_refused(Session session) {
  try {
    session.server_info();
  } catch (const ClientError& error) {
    if (error.exit_code() == ExitCode::kNotAllowed) return true;
    throw;
  }
  return false;
}

}  // namespace

Backend::Backend(Environment environment, std::string server, wire::AccessFiles access, RetryPolicy policy)
    : environment_(std::move(environment)),
      server_(std::move(server)),
      access_(std::move(access)),
      policy_(std::move(policy)) {}

bool Backend::refuses_strangers() const {
  const base::MemoryFile stranger("a token", random_key());
  return is_refused(session(stranger));
}

bool Backend::refuses_us() const {
  return is_refused(session());
}

// What goes on is not told: the page shows results alone.
Session Backend::session_with(const wire::AccessFiles& access, std::stop_token stop) const {
  RetryPolicy policy = policy_;
  if (stop.stop_possible()) policy.stop = std::move(stop);
  return {choose_server(server_, environment_, access), environment_, {}, std::move(policy)};
}

Session Backend::session(std::stop_token stop) const {
  return session_with(access_, std::move(stop));
}

Session Backend::session(const base::MemoryFile& token, std::stop_token stop) const {
  wire::AccessFiles access = access_;
  access.token_file = token.path();
  return session_with(access, std::move(stop));
}

}  // namespace affskel::client

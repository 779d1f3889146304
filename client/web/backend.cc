#include "client/web/backend.h"

#include "client/web/random_key.h"

namespace affskel::client {
namespace {

ConsoleStyle warnings_alone() {
  ConsoleStyle style;
  style.quiet = true;
  return style;
}

bool is_refused(Backend::Call& server) {
  try {
    server.session().server_info();
  } catch (const ClientError& error) {
    if (error.exit_code() == ExitCode::kNotAllowed) return true;
    throw;
  }
  return false;
}

}  // namespace

Backend::Call::Call(const Environment& environment, const GlobalOptions& global, const RetryPolicy& policy)
    : console_(out_, err_, warnings_alone()), context_(console_, out_, environment, global, policy) {}

std::vector<std::string> Backend::Call::warnings() const {
  constexpr std::string_view kLabel = "warning: ";
  std::vector<std::string> warnings;
  std::istringstream lines(err_.str());
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(kLabel)) warnings.push_back(line.substr(kLabel.size()));
  }
  return warnings;
}

Backend::Backend(Environment environment, GlobalOptions global, RetryPolicy policy)
    : environment_(std::move(environment)), global_(std::move(global)), policy_(std::move(policy)) {}

bool Backend::refuses_strangers() const {
  const base::MemoryFile stranger("a token", random_key());
  return is_refused(*call(stranger));
}

bool Backend::refuses_us() const {
  return is_refused(*call());
}

RetryPolicy Backend::policy_until(std::stop_token stop) const {
  RetryPolicy policy = policy_;
  if (stop.stop_possible()) policy.stop = std::move(stop);
  return policy;
}

std::unique_ptr<Backend::Call> Backend::call(std::stop_token stop) const {
  return std::make_unique<Call>(environment_, global_, policy_until(std::move(stop)));
}

std::unique_ptr<Backend::Call> Backend::call(const base::MemoryFile& token, std::stop_token stop) const {
  GlobalOptions global = global_;
  global.access.token_file = token.path();
  return std::make_unique<Call>(environment_, global, policy_until(std::move(stop)));
}

}  // namespace affskel::client

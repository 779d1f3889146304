#pragma once

#include <iosfwd>
#include <optional>
#include <string>

#include "client/cli/console.h"
#include "client/cli/global_options.h"
#include "client/connection/environment.h"
#include "client/connection/session.h"

namespace affskel::client {

/// What every command works with.  The server is looked for when it is first needed.
class Context {
 public:
  /// @param out standard output, for what is printed as it is in every mode; results go to the console.
  /// @param global --server and what is shown to it; empty = see choose_server.
  Context(Console& console, std::ostream& out, Environment environment, GlobalOptions global,
          RetryPolicy policy = {})
      : console_(console),
        out_(out),
        environment_(std::move(environment)),
        global_(std::move(global)),
        policy_(policy) {}

  Console& console() { return console_; }
  std::ostream& out() { return out_; }
  const Environment& environment() const { return environment_; }
  const GlobalOptions& global() const { return global_; }
  /// What `task` makes of a file, within its budget.
  template <class Task>
  auto within_budget(Budget::Work work, const std::string& file, const Task& task) const {
    const Budget budget(console_, global_.budgets, work, file);
    return task();
  }
  /// See client::next_command.
  std::string next_command(const std::string& words) const { return client::next_command(global_, words); }

  /// @throws ClientError as choose_server.
  Session& session();

 private:
  Console& console_;
  std::ostream& out_;
  Environment environment_;
  GlobalOptions global_;
  RetryPolicy policy_;
  std::optional<Session> session_;
};

}  // namespace affskel::client

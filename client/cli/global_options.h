#pragma once

#include <CLI/App.hpp>
#include <string>

#include "client/cli/budget.h"
#include "wire/channel.h"

namespace affskel::client {

/// Options that every command has.
struct GlobalOptions {
  std::string server;        ///< empty = environment, configuration, embedded
  wire::AccessFiles access;  ///< empty files = environment, configuration, none
  bool json = false;
  bool quiet = false;
  Budgets budgets;
};

/// Adds --server, what is shown to it, --json, --quiet and the budgets; parsing fills `options`, which must outlive it.
void add_global_options(CLI::App& app, GlobalOptions& options);

/// A command to type next, as a shell takes it: the program, what was given to reach the server, and `words`,
/// which are quoted already.
std::string next_command(const GlobalOptions& options, const std::string& words);

}  // namespace affskel::client

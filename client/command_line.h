#pragma once

#include <CLI/App.hpp>

#include "client/options.h"

namespace affskel::client {

/// Builds the tree of commands and options into `app`; parsing fills `options`.  Both must outlive the parse.
void build_command_line(CLI::App& app, Options& options);

/// A completion script for "bash", "zsh" or "fish", made from the tree.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace affskel::client

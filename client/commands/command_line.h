#pragma once

#include <CLI/App.hpp>

#include "client/commands/options.h"

namespace affskel::client {

/// Builds the tree of commands and options into `app`; parsing fills `options`.  Both must outlive the parse.
void build_command_line(CLI::App& app, Options& options);

}  // namespace affskel::client

#pragma once

#include <CLI/App.hpp>
#include <string>

namespace affskel::client {

/// Options that every command has.
struct GlobalOptions {
  std::string server;  ///< empty = environment, configuration, embedded
  bool json = false;
  bool quiet = false;
};

/// Adds --server, --json and --quiet; parsing fills `options`, which must outlive it.
void add_global_options(CLI::App& app, GlobalOptions& options);

}  // namespace affskel::client

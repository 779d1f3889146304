#pragma once

#include <CLI/App.hpp>
#include <string>

namespace affskel::client {

/// A completion script for "bash", "zsh" or "fish", made from the tree of commands and options.
/// @throws ClientError kUsage for another shell.
std::string completion_script(const CLI::App& app, const std::string& shell);

}  // namespace affskel::client

#pragma once

#include <CLI/App.hpp>
#include <string>

namespace affskel::client {

/// The manual page of a command line with all its commands, in roff for man(7): what --help says of each,
/// from the same tree.
std::string manual_page(const CLI::App& app);

}  // namespace affskel::client

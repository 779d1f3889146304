#pragma once

#include <CLI/App.hpp>
#include <string>

namespace affskel::client {

/// A required file to read. @param name of the operand, e.g. "FILE"; @param what it is, for the help.
void add_file(CLI::App* command, const std::string& name, std::string& file, const std::string& what);

}  // namespace affskel::client

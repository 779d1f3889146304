#pragma once

#include <CLI/App.hpp>
#include <optional>
#include <string>

namespace affskel::client {

/// The files that a mesh is read from, for the help.
std::string mesh_kinds();

/// --isovalue.
void add_isovalue(CLI::App* command, std::optional<double>& isovalue);

/// A required file to read. @param name of the operand, e.g. "FILE"; @param what it is, for the help.
void add_file(CLI::App* command, const std::string& name, std::string& file, const std::string& what);

}  // namespace affskel::client

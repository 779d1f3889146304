#pragma once

#include <string>

namespace affskel::server {

/// What is wrong with a file of options, with its name and the line: CLI11 tells neither.
/// @param error what CLI11 says of it.
std::string config_fault(const std::string& file, const std::string& error);

}  // namespace affskel::server

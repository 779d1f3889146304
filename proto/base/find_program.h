#pragma once

#include <filesystem>
#include <string>

namespace affskel::base {

/// Whether it is a file that this process may execute.
bool is_program(const std::filesystem::path& file);

/// The folder of the program that runs; empty when the system does not say.
std::filesystem::path own_directory();

/// Another program of ours: in the folder `beside`, else in the first absolute folder of a search path as
/// $PATH is one that has it; empty when there is none.
std::filesystem::path find_program(const std::string& name, const std::filesystem::path& beside,
                                   const std::string& search_path);

}  // namespace affskel::base

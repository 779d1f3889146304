#pragma once

#include <functional>
#include <string>

#include "client/commands/command_line.h"

namespace affskel::client {

/// Adds a command whose one argument is a job, see CommandLine::add().
/// @param run with the job's name.
void add_job_command(CommandLine& line, const std::string& name, const std::string& description,
                     const std::string& examples,
                     std::function<void(Context& context, const std::string& job)> run);

}  // namespace affskel::client

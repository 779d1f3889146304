#pragma once

#include <CLI/App.hpp>
#include <string>

namespace affskel::client {

// Options that commands about a job share.

/// JOB, the job that a command is about.
void add_job(CLI::App* command, std::string& job);

/// --output. @param what is written, for the help.
void add_output(CLI::App* command, std::string& output, const std::string& what);

/// --format, for commands that write one of several formats.
void add_format(CLI::App* command, std::string& format);

}  // namespace affskel::client

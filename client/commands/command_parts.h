#pragma once

#include <CLI/App.hpp>
#include <cstdint>
#include <string>

#include "client/commands/options.h"

namespace affskel::client {

// What the files that build the command line share.

CLI::Validator positive_number();
/// "0.1" or "10%", above 0 and below 1; rewrites it to a number.
CLI::Validator proper_share();
CLI::Validator whole_in(std::uint64_t low, std::uint64_t high);
/// An empty variable of a script must not mean another server or file than the one that was meant.
CLI::Validator given();
/// For what becomes a string of the protocol.
CLI::Validator utf8_text();

/// --format, for commands that write one of several formats.
void add_format(CLI::App* sub, std::string& format);

/// A command with its description and examples; choosing it sets options.command.
CLI::App* command(CLI::App& parent, Options& options, const std::string& name, Command which,
                  const std::string& description, const std::string& examples);

/// The job that a command is about.
void add_job(CLI::App* sub, Options& options);

/// --operator and --threshold.  Without a name of an operator in `skeleton` the default is the job's.
void add_skeleton_options(CLI::App* sub, SkeletonOptions& skeleton);

/// fetch, skeleton, surface, erode, render and view: commands that write what came of a job.
void add_result_commands(CLI::App& app, Options& options);
/// compare, transform and perturb: commands on files, without a server.
void add_shape_file_commands(CLI::App& app, Options& options);

}  // namespace affskel::client

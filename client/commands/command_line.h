#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <string>

#include "client/cli/global_options.h"
#include "client/commands/shared/context.h"

namespace affskel::client {

/// What a command does once the command line is parsed: it prints its results and throws ClientError when it
/// fails.  A job that ended badly is a failure of the commands that wait for it.
using Action = std::function<void(Context&)>;

/// Checks a command's options against each other.  Throws CLI::ParseError.
using OptionCheck = std::function<void(const CLI::App& command)>;

/// The tree of all commands and their options and, after the parse, the command that was chosen.
class CommandLine {
 public:
  /// The tree with every command of commands.h.
  CommandLine();
  CommandLine(const CommandLine&) = delete;
  CommandLine& operator=(const CommandLine&) = delete;

  /// Adds a command.  `action` must own what its options are parsed into.
  /// @param examples lines for the end of its help.
  /// @param check of the options together, if they need one.
  CLI::App* add(const std::string& name, const std::string& description, const std::string& examples,
                Action action, OptionCheck check = {});

  /// @param arguments without the program's name.  @throws CLI::ParseError, also for --help and --version.
  void parse(const std::vector<std::string>& arguments);

  CLI::App& app() { return app_; }
  const GlobalOptions& global() const { return global_; }

  /// Runs the command that the last parse chose.
  void run(Context& context) const { chosen_(context); }

 private:
  CLI::App app_;
  GlobalOptions global_;
  Action chosen_;
};

}  // namespace affskel::client

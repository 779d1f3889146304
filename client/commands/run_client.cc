#include "client/commands/run_client.h"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "client/commands/command_line.h"

namespace affskel::client {
namespace {

ConsoleStyle style_for(const GlobalOptions& global, const ClientIo& io) {
  const bool plain =
      global.quiet || global.json || !io.err_is_terminal || io.environment.get("TERM").value_or("") == "dumb";
  ConsoleStyle style;
  style.json = global.json;
  style.quiet = global.quiet;
  style.terminal = !plain && !io.environment.get("NO_COLOR");
  style.colour = style.terminal;
  return style;
}

// --help and --version end the parse with a "success"; everything else is wrong usage.
int report_parse_end(CLI::App& app, const CLI::ParseError& end, const std::vector<std::string>& arguments,
                     const ClientIo& io) {
  if (end.get_exit_code() == 0) {
    app.exit(end, io.out, io.err);
    io.out.flush();
    return 0;
  }
  // The command as far as it was understood, for the hint.
  std::string command = "affskel-client";
  for (const CLI::App* level = &app; level != nullptr;) {
    const auto chosen = level->get_subcommands();
    level = chosen.empty() ? nullptr : chosen.front();
    if (level != nullptr) command += " " + level->get_name();
  }
  GlobalOptions global;
  global.json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
  if (arguments.empty()) io.err << app.help();
  const bool no_command =
      end.get_name() == "RequiredError" && std::string(end.what()).find("subcommand") != std::string::npos;
  // CLI11 leaves a misspelt command over: naming it helps more than naming what is missing.
  const std::vector<std::string> unknown = no_command ? app.remaining(true) : std::vector<std::string>();
  const std::string missing =
      unknown.empty() ? "no command was given" : "no command '" + unknown.front() + "'";
  const std::string cause = no_command ? missing : end.what();
  Console console(io.out, io.err, style_for(global, io));
  console.error(ClientError(ExitCode::kUsage, cause + "; see " + command + " --help"));
  return static_cast<int>(ExitCode::kUsage);
}

// Runs `task`; every failure becomes a message and an exit code.
template <typename Task>
int guarded(Console& console, Task&& task) {
  const auto report = [&](const ClientError& error) {
    console.error(error);
    return static_cast<int>(error.exit_code());
  };
  try {
    task();
    console.finish();
    return 0;
  } catch (const ClientError& error) {
    return report(error);
  } catch (const core::CoreError& error) {
    return report(error_from_core(error, ""));
  } catch (const base::FileError& error) {
    return report(error_from_file(error));
  } catch (const std::bad_alloc&) {
    return report(ClientError(ExitCode::kLimit, "out of memory"));
  } catch (const std::exception& error) {
    return report(ClientError(ExitCode::kInternal, std::string("internal error: ") + error.what()));
  }
}

}  // namespace

int run_client(const std::vector<std::string>& arguments, const ClientIo& io) {
  CommandLine line;
  try {
    line.parse(arguments);
  } catch (const CLI::ParseError& end) {
    return report_parse_end(line.app(), end, arguments, io);
  }
  Console console(io.out, io.err, style_for(line.global(), io));
  return guarded(console, [&] {
    Context context(console, io.out, io.environment, line.global(), io.retry);
    line.run(context);
  });
}

}  // namespace affskel::client

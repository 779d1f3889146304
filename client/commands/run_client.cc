#include "client/commands/run_client.h"

#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <set>
#include <sstream>

#include "client/cli/progress.h"
#include "client/commands/command_line.h"
#include "client/text/nearest_word.h"
#include "wire/version.h"

namespace affskel::client {
namespace {

ConsoleStyle style_for(const GlobalOptions& global, const ClientIo& io) {
  const bool plain = global.quiet || global.json || io.environment.get("NO_COLOR") ||
                     io.environment.get("TERM").value_or("") == "dumb";
  ConsoleStyle style;
  style.json = global.json;
  style.quiet = global.quiet;
  style.terminal = !plain && io.err_is_terminal;
  style.colour = style.terminal;
  style.out_colour = !plain && io.out_is_terminal;
  if (io.out_is_terminal) style.out_columns = terminal_columns(STDOUT_FILENO);
  return style;
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

// The command as far as it was understood: the program, its command, the command's own.
std::vector<const CLI::App*> understood(const CLI::App& app) {
  std::vector<const CLI::App*> levels = {&app};
  for (auto chosen = app.get_subcommands(); !chosen.empty(); chosen = levels.back()->get_subcommands())
    levels.push_back(chosen.front());
  return levels;
}

std::string with_nearest(const std::string& text, const std::string& word,
                         const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(word, known);
  return nearest.empty() ? text : text + "; did you mean " + nearest + "?";
}

// Whether it was given behind "--" alone, where no option is one.
bool behind_options(const std::string& word, const std::vector<std::string>& arguments) {
  const auto end = std::find(arguments.begin(), arguments.end(), "--");
  return end != arguments.end() && std::find(arguments.begin(), end, word) == end;
}

std::string unknown_option(const std::string& word, const std::vector<const CLI::App*>& levels, bool behind) {
  std::vector<std::string> known;
  for (auto level = levels.rbegin(); level != levels.rend(); ++level) {
    for (const CLI::Option* option : (*level)->get_options()) {
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
      for (const std::string& name : option->get_snames()) known.push_back("-" + name);
    }
  }
  const std::string name = word.substr(0, word.find('='));
  if (behind && std::find(known.begin(), known.end(), name) != known.end())
    return "options come before --, which ends them: " + name;
  return with_nearest("unknown option " + name, name, known);
}

// "command", or what a command's own are: "shape".
std::string kind_below(const CLI::App& level) {
  if (level.get_parent() == nullptr) return "command";
  const std::string group = level.get_subcommands([](const CLI::App*) { return true; }).front()->get_group();
  return CLI::detail::to_lower(group.substr(0, group.size() - 1));  // "Shapes"
}

std::string unknown_command(const std::string& word, const CLI::App& level) {
  std::vector<std::string> known;
  for (const CLI::App* child : level.get_subcommands([](const CLI::App*) { return true; }))
    known.push_back(child->get_name());
  const std::string text = with_nearest("no " + kind_below(level) + " '" + word + "'", word, known);
  if (text.ends_with('?') || level.get_parent() == nullptr) return text;
  return text + "; " + level.get_name() + " knows " + CLI::detail::join(known, ", ");
}

// CLI11's "At Most 2 required but received 3", or "At least".
std::string plain_mismatch(std::string text) {
  for (const char* const bound : {"At Most", "At least"})
    text = CLI::detail::find_and_replace(text, bound, CLI::detail::to_lower(bound));
  return CLI::detail::find_and_replace(text, " required but received", ", not");
}

// Of the words that are left over the first few, in the order in which they were given; a pattern may have become thousands.
std::string unexpected_words(const std::vector<std::string>& left,
                             const std::vector<std::string>& arguments) {
  constexpr std::size_t kShown = 3;
  std::multiset<std::string> searched(left.begin(), left.end());
  std::vector<std::string> found;
  for (auto word = arguments.rbegin(); word != arguments.rend() && !searched.empty(); ++word) {
    const auto at = searched.find(*word);
    if (at == searched.end()) continue;
    searched.erase(at);
    found.push_back(*word);
  }
  std::reverse(found.begin(), found.end());
  std::string text = "not expected: ";
  for (std::size_t i = 0; i < std::min(kShown, found.size()); ++i) text += (i == 0 ? "" : " ") + found[i];
  return found.size() <= kShown ? text : text + " and " + std::to_string(found.size() - kShown) + " more";
}

// What is wrong with the usage.  CLI11 leaves a misspelt word over: naming it, and what was probably meant,
// helps more than naming what is missing without it.
std::string usage_error(const CLI::App& app, const CLI::ParseError& end,
                        const std::vector<const CLI::App*>& levels,
                        const std::vector<std::string>& arguments) {
  std::vector<std::string> unknown = app.remaining(true);
  std::erase(unknown, "--");  // what only ends the options
  const auto is_option = [](const std::string& word) { return word.size() > 1 && word.front() == '-'; };
  const auto option = std::find_if(unknown.begin(), unknown.end(), is_option);
  const auto word = std::find_if_not(unknown.begin(), unknown.end(), is_option);
  const bool no_command =
      end.get_name() == "RequiredError" && std::string(end.what()).find("subcommand") != std::string::npos;
  // The options of a command that is not known are not known either; below a command CLI11 does not keep
  // their order.
  const bool command_first = word != unknown.end() && (word == unknown.begin() || levels.size() > 1);
  if (no_command && command_first) return unknown_command(*word, *levels.back());
  if (option != unknown.end()) return unknown_option(*option, levels, behind_options(*option, arguments));
  if (end.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))
    return unexpected_words(unknown, arguments);
  return no_command ? "no " + kind_below(*levels.back()) + " was given" : plain_mismatch(end.what());
}

// --help and --version end the parse with a "success"; everything else is wrong usage.
int report_parse_end(CLI::App& app, const CLI::ParseError& end, const std::vector<std::string>& arguments,
                     const ClientIo& io) {
  GlobalOptions global;
  global.json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
  if (end.get_exit_code() == 0) {
    const bool version = global.json && end.get_name() == "CallForVersion";
    Console console(io.out, io.err, version ? style_for(global, io) : ConsoleStyle());
    return guarded(console, [&] {
      if (version) {
        console.document({{"program", "affskel-client"}, {"version", wire::kVersion}});
        return;
      }
      std::ostringstream text;
      app.exit(end, text, io.err);
      console.result(text.str());
    });
  }
  const std::vector<const CLI::App*> levels = understood(app);
  std::string command;
  for (const CLI::App* level : levels) command += (command.empty() ? "" : " ") + level->get_name();
  if (arguments.empty()) io.err << app.help();
  Console console(io.out, io.err, style_for(global, io));
  const std::string wrong = usage_error(app, end, levels, arguments);
  const std::string help = (wrong.ends_with('?') ? " See " : "; see ") + command + " --help";
  console.error(ClientError(ExitCode::kUsage, wrong + help));
  return static_cast<int>(ExitCode::kUsage);
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

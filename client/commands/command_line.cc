#include "client/commands/command_line.h"

#include <CLI/CLI.hpp>

#include "client/cli/exit_codes.h"
#include "client/cli/help_format.h"
#include "client/commands/commands.h"
#include "wire/version.h"

namespace affskel::client {
namespace {

std::string exit_codes_text() {
  constexpr std::size_t kWidth = 100;
  std::string text, line = "Exit codes:";
  for (const auto& [code, meaning] : kExitCodes) {
    const std::string next =
        std::to_string(code) + " " + std::string(meaning) + (code == kExitCodes.back().first ? "." : ",");
    if (line.size() + 1 + next.size() > kWidth) {
      text += line + "\n";
      line = next;
    } else {
      line += " " + next;
    }
  }
  return text + line;
}

}  // namespace

CommandLine::CommandLine() {
  app_.name("affskel-client");
  app_.description(
      "Affine skeletons: the thin surface in the middle of what a closed triangle mesh bounds, which hardly\n"
      "reacts to noise and follows affine maps. To see a shape's inside, measure its limbs, compare or pose\n"
      "it. Begin with: affskel-client submit body.off -o results");
  app_.set_version_flag("--version", std::string("affskel-client ") + wire::kVersion);
  app_.fallthrough();  // global options may also follow the command
  app_.require_subcommand(1);
  app_.formatter(std::make_shared<HelpFormatter>());
  add_global_options(app_, global_);
  for (const AddCommand add_command : kCommands) add_command(*this);
  app_.footer(
      "Examples:\n"
      "  affskel-client make body -o body.off\n"
      "  affskel-client submit body.off --spacing 1% -o OUT\n"
      "  affskel-client render @last -o body.png\n"
      "  affskel-client view @last -o body.html\n"
      "'affskel-client COMMAND --help' tells more, 'affskel-client man | man -l -' all of it.\n" +
      exit_codes_text());
}

CLI::App* CommandLine::add(const std::string& name, const std::string& description,
                           const std::string& examples, Action action, OptionCheck check) {
  CLI::App* command = app_.add_subcommand(name, description);
  command->group("Commands");
  command->footer("Examples:\n" + examples +
                  "\nOptions for all commands (--server, --json, --quiet): affskel-client --help");
  command->callback([this, command, action = std::move(action), check = std::move(check)] {
    if (check) check(*command);
    chosen_ = action;
  });
  return command;
}

void CommandLine::parse(const std::vector<std::string>& arguments) {
  app_.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them reversed
}

}  // namespace affskel::client

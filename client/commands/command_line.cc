#include "client/commands/command_line.h"

#include <CLI/CLI.hpp>

#include "client/cli/help_format.h"
#include "client/commands/commands.h"
#include "wire/version.h"

namespace affskel::client {

CommandLine::CommandLine() {
  app_.name("affskel-client");
  app_.description("Affine skeletons of closed triangle meshes: submit, follow, fetch.");
  app_.set_version_flag("--version", std::string("affskel-client ") + wire::kVersion);
  app_.fallthrough();  // global options may also follow the command
  app_.require_subcommand(1);
  app_.formatter(std::make_shared<HelpFormatter>());
  add_global_options(app_, global_);
  for (const AddCommand add_command : kCommands) add_command(*this);
  app_.footer(
      "Examples:\n"
      "  affskel-client make body -o body.off\n"
      "  affskel-client submit body.off --spacing 200 -o OUT\n"
      "  affskel-client render @last -o body.png\n"
      "  affskel-client view @last -o body.html\n"
      "'affskel-client COMMAND --help' tells more. Exit codes: 0 done, 1 job failed, 2 usage, 3 bad input\n"
      "file, 4 no such job or artefact, 5 server unreachable, 6 cancelled, 7 not allowed, 8 limit reached,\n"
      "70 internal error.");
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

#include "client/cli/completions.h"

#include <CLI/CLI.hpp>
#include <memory>
#include <ostream>

#include "client/cli/value_checks.h"
#include "client/commands/commands.h"

namespace affskel::client {

void add_completions(CommandLine& line) {
  const auto shell = std::make_shared<std::string>();
  CLI::App* command = line.add(
      "completions", "Completion script for a shell",
      "  affskel-client completions bash > ~/.local/share/bash-completion/completions/affskel-client\n"
      "  affskel-client completions fish > ~/.config/fish/completions/affskel-client.fish",
      [&line, shell](Context& context) { context.out() << completion_script(line.app(), *shell); });
  command->add_option("SHELL", *shell, "Which shell")
      ->required()
      ->check(one_of({"bash", "zsh", "fish"}))
      ->type_name("");
}

}  // namespace affskel::client

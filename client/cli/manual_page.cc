#include "client/cli/manual_page.h"

#include <CLI/CLI.hpp>

#include "client/cli/exit_codes.h"
#include "client/cli/help_format.h"
#include "wire/version.h"

namespace affskel::client {
namespace {

// Text as roff prints it: a backslash begins an escape, a hyphen would become a typographic one, and a dot or
// an apostrophe at the beginning of a line is a request.
std::string roff(const std::string& text) {
  std::string safe;
  bool at_start = true;
  for (const char c : text) {
    if (at_start && (c == '.' || c == '\'')) safe += "\\&";
    if (c == '\\') {
      safe += "\\e";
    } else if (c == '-') {
      safe += "\\-";
    } else {
      safe += c;
    }
    at_start = c == '\n';
  }
  return safe;
}

// Words alone: the help breaks its lines where they suit it.
std::string paragraph(std::string text) {
  for (char& c : text) c = c == '\n' ? ' ' : c;
  return roff(text) + "\n";
}

std::string lines_as_they_are(const std::string& text) {
  return ".PP\n.nf\n" + roff(text) + "\n.fi\n";
}

std::string option_names(const CLI::Option& option) {
  std::string text;
  const auto add = [&text](const std::string& name) {
    text += (text.empty() ? "\\fB" : ", \\fB") + roff(name) + "\\fR";
  };
  for (const std::string& name : option.get_snames()) add("-" + name);
  for (const std::string& name : option.get_lnames()) add("--" + name);
  const std::string value = placeholder(option);
  return value.empty() ? text : text + " \\fI" + roff(value) + "\\fR";
}

std::string options_of(const CLI::App& app) {
  const HelpFormatter format;
  std::string text;
  for (const CLI::Option* option : app.get_options()) {
    const std::string name =
        option->get_positional() ? "\\fI" + roff(option->get_name()) + "\\fR" : option_names(*option);
    text += ".TP\n" + name + "\n" + paragraph(format.make_option_desc(option));
  }
  return text;
}

std::string usage_of(const CLI::App& app, const std::string& path) {
  std::string text = "\\fB" + roff(path) + "\\fR";
  for (const CLI::Option* option : app.get_options()) {
    if (option->get_positional()) text += " \\fI" + roff(option->get_name()) + "\\fR";
  }
  return text + " [\\fIOPTIONS\\fR]";
}

// A command and those below it, but for what no person types.
std::string commands_below(const CLI::App& app, const std::string& path) {
  std::string text;
  for (const CLI::App* command :
       app.get_subcommands([](const CLI::App* child) { return !child->get_group().empty(); })) {
    const std::string name = path + command->get_name();
    text += ".SS " + usage_of(*command, name) + "\n" + paragraph(command->get_description() + ".");
    text += options_of(*command);
    text += lines_as_they_are(command->get_footer());
    text += commands_below(*command, name + " ");
  }
  return text;
}

std::string exit_status() {
  std::string text;
  for (const auto& [code, meaning] : kExitCodes)
    text += ".TP\n" + std::to_string(code) + "\n" + roff(std::string(meaning)) + "\n";
  return text;
}

}  // namespace

std::string manual_page(const CLI::App& app) {
  const std::string name = app.get_name();
  return ".TH AFFSKEL\\-CLIENT 1 \"\" \"affskel " + roff(wire::kVersion) + "\" \"User Commands\"\n" +
         ".SH NAME\n" + roff(name) + " \\- affine skeletons of closed triangle meshes\n" +
         ".SH SYNOPSIS\n\\fB" + roff(name) + "\\fR [\\fIOPTIONS\\fR] \\fICOMMAND\\fR ...\n" +
         ".SH DESCRIPTION\n" + paragraph(app.get_description()) +
         ".SH OPTIONS\nThese may also follow the command.\n" + options_of(app) + ".SH COMMANDS\n" +
         commands_below(app, "") + ".SH EXIT STATUS\n" + exit_status() +
         ".SH FILES\n.TP\n\\fI$XDG_CONFIG_HOME/affskel/config\\fR\nLines KEY = VALUE: server, token_file, "
         "tls_ca, "
         "client_cert, client_key.\n.TP\n\\fI$AFFSKEL_HOME\\fR, \\fI$XDG_DATA_HOME/affskel\\fR\n"
         "Data of the private server.\n";
}

}  // namespace affskel::client

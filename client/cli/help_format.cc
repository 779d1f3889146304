#include "client/cli/help_format.h"

#include <CLI/CLI.hpp>
#include <algorithm>

namespace affskel::client {
namespace {

constexpr int kMaxSpelt = 2;  // arguments of one name; more are "..."

}  // namespace

HelpFormatter::HelpFormatter() {
  column_width(28);
  label("SUBCOMMAND", "COMMAND");
  label("Subcommands", "Commands");
}

std::string placeholder(const CLI::Option& option) {
  // The full name is TYPE:VALIDATOR:...
  const std::string type = option.get_type_name();
  return type.substr(0, type.find(':'));
}

std::vector<std::string> possible_values(const CLI::Option& option) {
  // one_of() shows its words as {a,b,c} in the type's name.
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{'), close = type.find('}');
  if (open == std::string::npos || close == std::string::npos || close < open) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

std::string HelpFormatter::make_option_opts(const CLI::Option* option) const {
  const std::string name = placeholder(*option);
  return name.empty() || option->get_positional() ? "" : " " + name;
}

std::string HelpFormatter::make_option_usage(const CLI::Option* positional) const {
  const std::string name = make_option_name(positional, true);
  std::string words;
  for (int i = 0; i < std::min(positional->get_expected_max(), kMaxSpelt); ++i) {
    const bool optional = i >= positional->get_expected_min() || !positional->get_required();
    words += (i > 0 ? " " : "") + (optional ? "[" + name + "]" : name);
  }
  return words + (positional->get_expected_max() > kMaxSpelt ? "..." : "");
}

std::string HelpFormatter::make_option_desc(const CLI::Option* option) const {
  std::string text = option->get_description();
  if (const auto values = possible_values(*option); !values.empty()) {
    text += (text.empty() ? "" : ": ") + CLI::detail::join(values, ", ");
  }
  std::string preset = option->get_default_str();
  if (preset.empty()) return text;
  if (preset.front() == '[') preset = preset.substr(1, preset.size() - 2);  // a list
  return text + " (default: " + preset + ")";
}

}  // namespace affskel::client

#include "client/commands/shared/repair_option.h"

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/base/error.h"
#include "client/cli/number_parsers.h"
#include "client/text/shell_quoted.h"

namespace affskel::client {
namespace {

[[noreturn]] void no_repair(const std::string& text) {
  throw ClientError(ExitCode::kUsage,
                    "'" + text +
                        "': auto, none, fill=LENGTH, wrap or wrap=ALPHA is needed, in units "
                        "of the mesh");
}

// What other ways there are, where one has failed.
[[noreturn]] void advise(const Context& context, const std::string& file, const Repair& done) {
  const std::string again = "repair " + shell_quoted(file) + " --repair ";
  std::string fill;
  if (done.longest_left > 0) {
    const std::string length = base::rounded(1.01 * done.longest_left, 3);
    fill = "fill them by: " + context.next_command(again + "fill=" + length + " -o filled.off") + ", or ";
  }
  throw ClientError(ExitCode::kBadInput,
                    done.left + "; " + fill + "take a new surface round all of it: " +
                        context.next_command(again + "wrap -o wrapped.off"),
                    file);
}

}  // namespace

void add_repair_option(CLI::App* command, std::string& how, const std::string& what) {
  const auto refuse = [](std::string& text) -> std::string {
    try {
      chosen_repair(text);
      return {};
    } catch (const ClientError& error) {
      return error.what();
    }
  };
  command->add_option("--repair", how, what)
      ->check(CLI::Validator(refuse, "{auto,none,wrap,wrap=ALPHA,fill=LENGTH}", ""))
      ->capture_default_str()
      ->type_name("HOW");
}

RepairChoice chosen_repair(const std::string& text) {
  using Kind = RepairChoice::Kind;
  if (text == "auto") return {};
  if (text == "none") return {Kind::kNone};
  if (text == "wrap") return {Kind::kWrap};
  const std::size_t sign = text.find('=');
  const auto value =
      sign == std::string::npos ? std::nullopt : parse_number(std::string_view(text).substr(sign + 1));
  if (!value || !(*value > 0)) no_repair(text);
  if (text.starts_with("fill=")) return {Kind::kFill, *value};
  if (text.starts_with("wrap=")) return {Kind::kWrap, 0, *value};
  no_repair(text);
}

nlohmann::ordered_json steps_json(const std::vector<core::RepairStep>& steps) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const core::RepairStep& step : steps)
    list.push_back({{"severity", core::severity_word(step.severity)},
                    {"code", step.code},
                    {"count", step.count},
                    {"message", step.message}});
  return list;
}

Repair repaired(const Context& context, const core::Mesh& mesh, const std::string& file,
                const RepairChoice& choice) {
  Repair done = repair(mesh, file, choice);
  if (!done.left.empty()) advise(context, file, done);
  return done;
}

}  // namespace affskel::client

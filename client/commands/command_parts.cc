#include "client/commands/command_parts.h"

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>

#include "client/cli/number_parsers.h"
#include "client/text/words.h"
#include "core/base/number_text.h"
#include "wire/utf8.h"

namespace affskel::client {

CLI::Validator positive_number() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        double value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = error == std::errc{} && end == text.data() + text.size();
        return good && std::isfinite(value) && value > 0 ? "" : "must be a number > 0, not '" + text + "'";
      },
      "");
}

CLI::Validator proper_share() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        const std::optional<double> share = parse_share(text);
        if (!share || !(*share > 0 && *share < 1)) {
          return "must be a share between 0 and 1 as in 0.1 or 10%, not '" + text + "'";
        }
        text = core::to_text(*share);
        return "";
      },
      "");
}

CLI::Validator whole_in(std::uint64_t low, std::uint64_t high) {
  return CLI::Validator(
      [low, high](std::string& text) -> std::string {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool whole = error == std::errc{} && end == text.data() + text.size();
        return whole && value >= low && value <= high
                   ? ""
                   : "must be a whole number from " + std::to_string(low) + " to " + std::to_string(high) +
                         ", not '" + text + "'";
      },
      "");
}

CLI::Validator given() {
  return CLI::Validator(
      [](std::string& text) -> std::string { return text.empty() ? "must not be empty" : ""; }, "");
}

CLI::Validator utf8_text() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        return wire::is_utf8(text) ? "" : "must be UTF-8 text, not '" + wire::to_utf8(text) + "'";
      },
      "");
}

CLI::App* command(CLI::App& parent, Options& options, const std::string& name, Command which,
                  const std::string& description, const std::string& examples) {
  CLI::App* sub = parent.add_subcommand(name, description);
  sub->group("Commands");
  sub->footer("Examples:\n" + examples +
              "\nOptions for all commands (--server, --json, --quiet): affskel-client --help");
  sub->callback([&options, which] { options.command = which; });
  return sub;
}

void add_job(CLI::App* sub, Options& options) {
  sub->add_option("JOB", options.job.job, "Id, unique prefix of at least 6 characters, or @last")
      ->required()
      ->check(utf8_text())
      ->type_name("");
}

void add_format(CLI::App* sub, std::string& format) {
  sub->add_option("--format", format, "Format, whatever the file's name: csv, ply, ...")
      ->check(given())
      ->type_name("EXT");
}

void add_skeleton_options(CLI::App* sub, SkeletonOptions& skeleton) {
  const bool of_job = skeleton.operator_name.empty();
  CLI::Option* name =
      sub->add_option("--operator", skeleton.operator_name,
                      std::string("How shocks are found") + (of_job ? " (default: the job's operator)" : ""))
          ->check(CLI::IsMember(operator_names()))
          ->type_name("OP");
  if (!of_job) name->capture_default_str();
  sub->add_option(
         "--threshold", skeleton.threshold,
         std::string("Keep points with |H| above this, of chords what is more significant (default: ") +
             (of_job ? "the operator's; without --operator the job's)" : "the operator's)"))
      ->check(positive_number())
      ->type_name("T");
}

}  // namespace affskel::client

#include "client/cli/value_checks.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "base/number_text.h"
#include "base/utf8.h"
#include "client/cli/number_parsers.h"
#include "client/text/nearest_word.h"
#include "client/text/shell_quoted.h"
#include "wire/params.h"

namespace affskel::client {

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string list = "{" + CLI::detail::join(words, ",") + "}";
  return CLI::Validator(
      [words = std::move(words)](std::string& text) -> std::string {
        if (std::find(words.begin(), words.end(), text) != words.end()) return "";
        const std::string nearest = nearest_word(text, words);
        return "must be one of " + CLI::detail::join(words, ", ") + ", not '" + base::to_utf8(text) + "'" +
               (nearest.empty() ? "" : "; did you mean " + nearest + "?");
      },
      list);
}

CLI::Validator finite_number() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        return parse_number(text) ? "" : "must be a number, not '" + text + "'";
      },
      "");
}

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

namespace {

/// @param range as a message names it.
CLI::Validator share_check(bool all, const std::string& range) {
  return CLI::Validator(
      [all, range](std::string& text) -> std::string {
        const std::optional<double> share = parse_share(text);
        if (!share || !(*share > 0 && (*share < 1 || (all && *share == 1)))) {
          return "must be a share " + range + " as in 0.1 or 10%, not '" + text + "'";
        }
        text = base::to_text(*share);
        return "";
      },
      "");
}

}  // namespace

CLI::Validator proper_share() {
  return share_check(false, "between 0 and 1");
}

CLI::Validator share_or_all() {
  return share_check(true, "above 0 and at most 1");
}

CLI::Validator positive_number_or_share() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        std::string copy = text;
        const bool good = (text.ends_with('%') ? proper_share() : positive_number())(copy).empty();
        return good ? "" : "must be a number > 0 or a share below 100% as in 1%, not '" + text + "'";
      },
      "");
}

CLI::Validator whole_number(std::uint64_t low, std::uint64_t high) {
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

namespace {

// How many of these are a byte count's unit; nothing where it has none.
std::optional<std::uint64_t> unit_of(std::string_view suffix) {
  if (suffix.empty()) return 1;
  const std::size_t power = std::string_view("KMG").find(suffix);
  if (suffix.size() > 1 || power == std::string_view::npos) return std::nullopt;
  return std::uint64_t{1} << (10 * (power + 1));
}

std::optional<std::uint64_t> parse_bytes(const std::string& text) {
  std::uint64_t count = 0;
  const char* const end = text.data() + text.size();
  const auto [behind, error] = std::from_chars(text.data(), end, count);
  const std::optional<std::uint64_t> unit = unit_of({behind, static_cast<std::size_t>(end - behind)});
  if (error != std::errc{} || !unit || count > std::numeric_limits<std::uint64_t>::max() / *unit)
    return std::nullopt;
  return count * *unit;
}

}  // namespace

CLI::Validator byte_count() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        const std::optional<std::uint64_t> bytes = parse_bytes(text);
        if (!bytes) {
          return "must be a whole number of bytes, or one with K, M or G for powers of 1024 behind it, not '" +
                 base::to_utf8(text) + "'";
        }
        text = std::to_string(*bytes);
        return "";
      },
      "");
}

CLI::Validator non_empty() {
  return CLI::Validator(
      [](std::string& text) -> std::string { return text.empty() ? "must not be empty" : ""; }, "");
}

CLI::Validator utf8_text() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        return base::is_utf8(text) ? "" : "must be UTF-8 text, not '" + base::to_utf8(text) + "'";
      },
      "");
}

CLI::Validator job_id() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        if (!base::is_utf8(text)) return "must be UTF-8 text, not '" + base::to_utf8(text) + "'";
        const bool hex = text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
        std::error_code unseen;
        if (hex || text.starts_with('@') || !std::filesystem::is_regular_file(text, unseen)) return "";
        return "'" + text + "' is a file, not a job; submit it first: affskel-client submit " +
               shell_quoted(text);
      },
      "");
}

CLI::Validator direction_set() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        try {
          text = wire::canonical_directions(text);
          return {};
        } catch (const std::invalid_argument& error) {
          return error.what();
        }
      },
      "");
}

namespace {

constexpr const char* kMeshFile = "mesh file";

}  // namespace

CLI::Validator mesh_file() {
  return non_empty().name(kMeshFile);
}

bool is_mesh_file(const CLI::Option& option) {
  try {
    const_cast<CLI::Option&>(option).get_validator(kMeshFile);
    return true;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

}  // namespace affskel::client

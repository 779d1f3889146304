#include "client/cli/number_parsers.h"

#include <charconv>
#include <cmath>
#include <string>

namespace affskel::client {

std::optional<double> parse_number(std::string_view text) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> parse_share(std::string_view text) {
  while (text.ends_with(' ')) text.remove_suffix(1);
  if (!text.ends_with('%')) return parse_number(text);
  text.remove_suffix(1);
  const std::optional<double> percent = parse_number(text);
  if (!percent) return std::nullopt;
  // The decimal point moves in the text: a division would round a second time.
  if (text.find_first_of("eE") != std::string_view::npos) return *percent / 100;
  while (text.ends_with(' ')) text.remove_suffix(1);
  return parse_number(std::string(text) + "e-2");
}

std::optional<std::vector<double>> parse_numbers(std::string_view text) {
  std::vector<double> numbers;
  for (std::size_t at = 0;;) {
    const std::size_t comma = text.find(',', at);
    const std::optional<double> number = parse_number(text.substr(at, comma - at));
    if (!number) return std::nullopt;
    numbers.push_back(*number);
    if (comma == std::string_view::npos) return numbers;
    at = comma + 1;
  }
}

}  // namespace affskel::client

#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace affskel::client {

/// A finite number and nothing else; a leading plus sign is allowed.
std::optional<double> parse_number(std::string_view text);

/// A share: a number or, with a percent sign, a hundredth of it.  "0.5%" is "0.005" to the last bit.
std::optional<double> parse_share(std::string_view text);

/// Finite numbers separated by commas, blanks round them allowed; at least one.
std::optional<std::vector<double>> parse_numbers(std::string_view text);

}  // namespace affskel::client

#pragma once

#include <string>
#include <string_view>

namespace affskel::client {

/// The text with a question mark for what drives a terminal, in job names and the like: control characters
/// (C0 and C1), and those that turn the direction of writing; U+FFFD for what is not UTF-8. Line ends and
/// tabs stay.
std::string printable(std::string_view text);

/// The same, with spaces for line ends and tabs: for comments of files, where a second line would be data.
std::string one_line(std::string_view text);

}  // namespace affskel::client

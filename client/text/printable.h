#pragma once

#include <string>
#include <string_view>

namespace affskel::client {

/// The text with a question mark for what drives a terminal or deceives its reader, in job names and the
/// like: control characters, separators of lines, what turns the direction of writing, what is not seen (by
/// the tables of Unicode; joiners and the selectors of emoji stay); U+FFFD for what is not UTF-8. Line ends
/// and tabs stay.
std::string printable(std::string_view text);

/// The same, with spaces for line ends and tabs: for comments of files, where a second line would be data.
std::string one_line(std::string_view text);

}  // namespace affskel::client

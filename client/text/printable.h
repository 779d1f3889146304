#pragma once

#include <string>
#include <string_view>

namespace affskel::client {

/// The text with control characters (of job names and the like) replaced, so that it cannot drive the
/// terminal.
std::string printable(std::string_view text);

/// The same, with spaces for line ends and tabs: for comments of files, where a second line would be data.
std::string one_line(std::string_view text);

}  // namespace affskel::client

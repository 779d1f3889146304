#pragma once

#include <string>
#include <vector>

namespace affskel::client {

/// The words of a line that is being typed, as a POSIX shell cuts and unquotes them; nothing is expanded, and
/// a quote may be open.
std::vector<std::string> shell_words(const std::string& line);

}  // namespace affskel::client

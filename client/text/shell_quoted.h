#pragma once

#include <string>

namespace affskel::client {

/// A word as a POSIX shell takes it back: as it is where no character has a meaning of its own, else in
/// single quotes.
std::string shell_quoted(const std::string& word);

}  // namespace affskel::client

#pragma once

#include <string>
#include <string_view>

namespace affskel::client {

/// Whether the text is well-formed UTF-8 (Unicode 15, table 3-7: no overlong forms, no surrogates).
/// Messages of the protocol carry nothing else; file names and arguments may hold any bytes.
bool is_utf8(std::string_view text);

/// The text with U+FFFD in place of every byte that is not part of a well-formed character.
std::string to_utf8(std::string_view text);

}  // namespace affskel::client

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace affskel::base {

/// Whether the text is well-formed UTF-8 (Unicode 15, table 3-7: no overlong forms, no surrogates).
/// Messages of the protocol carry nothing else; file names and arguments may hold any bytes.
bool is_utf8(std::string_view text);

/// The text with U+FFFD in place of every byte that is not part of a well-formed character.
std::string to_utf8(std::string_view text);

/// The longest beginning of `text` that has at most `max_bytes` bytes and does not end inside a character.
/// Of text that is not well-formed it may be shorter than needed, never longer.
std::string_view truncate_utf8(std::string_view text, std::size_t max_bytes);

}  // namespace affskel::base

#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

namespace affskel::wire {

/// Somebody's text for a message: in single quotes, control characters as \xNN, so that it stays one line and
/// nothing is cut off at a NUL, and "..." for what lies beyond `bytes` bytes, cut at a character of UTF-8.
inline std::string quoted(std::string_view text, std::size_t bytes = 64) {
  const bool cut = text.size() > bytes;
  if (cut) {
    while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
    text = text.substr(0, bytes);
  }
  std::string result = "'";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      char escaped[5];
      std::snprintf(escaped, sizeof escaped, "\\x%02x", static_cast<unsigned>(byte));
      result += escaped;
    } else {
      result += c;
    }
  }
  return result + (cut ? "'..." : "'");
}

}  // namespace affskel::wire

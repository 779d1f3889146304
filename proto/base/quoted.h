#pragma once

#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>

#include "base/utf8.h"

namespace affskel::base {

/// The text, with "..." for what lies beyond `max_bytes` bytes, cut at a character of UTF-8: messages quote
/// what they are about, which may be megabytes.
inline std::string shortened(std::string text, std::size_t max_bytes) {
  if (text.size() <= max_bytes) return text;
  text.resize(truncate_utf8(text, max_bytes).size());
  return text + "...";
}

/// A caller's text for a message: in single quotes, control characters as \xNN, so that it stays one line and
/// nothing is cut off at a NUL, and "..." for what lies beyond `max_bytes` bytes, cut at a character of
/// UTF-8.
inline std::string quoted(std::string_view text, std::size_t max_bytes = 64) {
  const std::string_view kept = truncate_utf8(text, max_bytes);
  std::string result = "'";
  for (const char c : kept) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x20 || byte == 0x7F) {
      char escaped[5];
      std::snprintf(escaped, sizeof escaped, "\\x%02x", static_cast<unsigned>(byte));
      result += escaped;
    } else {
      result += c;
    }
  }
  return result + (kept.size() < text.size() ? "'..." : "'");
}

}  // namespace affskel::base

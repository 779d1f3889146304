#pragma once

#include <charconv>
#include <string>

namespace affskel::core {

/// The shortest decimal text that reads back as `value`, for messages.
inline std::string to_text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return std::string(buffer, result.ptr);
}

/// Rounded to `digits` significant digits, for people.
inline std::string rounded(double value, int digits) {
  char buffer[32];
  return {buffer,
          std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, digits).ptr};
}

}  // namespace affskel::core

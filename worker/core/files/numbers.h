#pragma once

#include <charconv>
#include <concepts>
#include <string>

namespace affskel::core {

/// Appends the number with 17 significant digits: reads back exactly.
inline void append_exact(std::string& text, double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 17);
  text.append(buffer, result.ptr);
}

inline void append_integer(std::string& text, std::integral auto value) {
  char buffer[24];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

/// With so many decimals, for columns.
inline std::string with_decimals(double value, int decimals) {
  char buffer[400];  // the largest double has 309 digits before the point
  return {buffer,
          std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed, decimals).ptr};
}

}  // namespace affskel::core

#pragma once

#include <bit>
#include <charconv>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <string>

namespace affskel::client {

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

// Raw copies of numbers are little-endian only because the machine is.
static_assert(std::endian::native == std::endian::little, "binary formats here are little-endian");

/// Appends the number's bytes, little-endian.
template <typename Number>
requires std::is_arithmetic_v<Number>
void append_bytes(std::string& bytes, Number value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  bytes.append(raw, sizeof value);
}

}  // namespace affskel::client

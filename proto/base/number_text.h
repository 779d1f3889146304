#pragma once

#include <charconv>
#include <concepts>
#include <string>
#include <string_view>

namespace affskel::base {

/// Appends the shortest decimal text that reads back as `value`: the one way in which a double is
/// printed.
inline void append_shortest(std::string& text, double value) {
  char buffer[32];
  text.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

/// The same as a text of its own.
inline std::string to_text(double value) {
  std::string text;
  append_shortest(text, value);
  return text;
}

/// Rounded to `digits` significant digits, for people: 9000, and 9e+09 only where that is shorter.
inline std::string rounded(double value, int digits) {
  char buffer[32];
  const char* end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific, digits - 1).ptr;
  std::from_chars(buffer, end, value);
  return to_text(value);
}

/// Digits of a measured volume that rounding leaves: what sums over a mesh's triangles lose is below 1e-12 of
/// it.
inline constexpr int kMeasureDigits = 12;

/// Rounded to `digits` significant digits and without an exponent where that has at most 15 digits before the
/// point and 6 zeros behind it: a measure for people, 8000000000 and not 8e+09.
inline std::string plain(double value, int digits) {
  char buffer[40];
  const char* end =
      std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::scientific, digits - 1).ptr;
  std::from_chars(buffer, end, value);
  const double size = value < 0 ? -value : value;
  if (!(size < 1e15 && size >= 1e-6)) return to_text(value);
  return std::string(buffer,
                     std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::fixed).ptr);
}

/// "1 edge", "2 edges": a count of things for people.  @param many where it is not `one` and an s.
template <std::integral Count>
std::string counted(Count count, std::string_view one, std::string_view many = {}) {
  std::string text = std::to_string(count) + " ";
  if (count == 1 || many.empty()) {
    text += one;
    if (count != 1) text += 's';
  } else {
    text += many;
  }
  return text;
}

}  // namespace affskel::base

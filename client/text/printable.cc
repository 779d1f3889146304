#include "client/text/printable.h"

#include <algorithm>

#include "base/utf8.h"

namespace affskel::client {
namespace {

bool is_control(std::string_view character) {
  const auto byte = [&](std::size_t n) { return static_cast<unsigned char>(character[n]); };
  if (character.size() == 1)
    return (byte(0) < 0x20 && character != "\n" && character != "\t") || byte(0) == 0x7f;
  if (character.size() == 2) return byte(0) == 0xC2 && byte(1) < 0xA0;  // C1: U+0080 .. U+009F
  if (character.size() != 3 || byte(0) != 0xE2) return false;
  // What turns the direction of writing: U+200E, U+200F, U+202A .. U+202E, U+2066 .. U+2069; and line ends.
  return (byte(1) == 0x80 && (byte(2) == 0x8E || byte(2) == 0x8F || (byte(2) >= 0xA8 && byte(2) <= 0xAE))) ||
         (byte(1) == 0x81 && byte(2) >= 0xA6 && byte(2) <= 0xA9);
}

}  // namespace

std::string printable(std::string_view text) {
  const std::string whole = base::to_utf8(text);
  std::string safe;
  safe.reserve(whole.size());
  for (std::string_view rest = whole; !rest.empty();) {
    std::size_t length = 1;
    while (length < rest.size() && (static_cast<unsigned char>(rest[length]) & 0xC0) == 0x80) ++length;
    const std::string_view character = rest.substr(0, length);
    safe += is_control(character) ? "?" : character;
    rest.remove_prefix(length);
  }
  return safe;
}

std::string one_line(std::string_view text) {
  std::string safe = printable(text);
  std::replace_if(
      safe.begin(), safe.end(), [](char c) { return c == '\n' || c == '\t'; }, ' ');
  return safe;
}

}  // namespace affskel::client

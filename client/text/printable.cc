#include "client/text/printable.h"

#include <algorithm>

namespace affskel::client {

std::string printable(std::string_view text) {
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool control = (byte < 0x20 && c != '\n' && c != '\t') || byte == 0x7f;
    safe.push_back(control ? '?' : c);
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

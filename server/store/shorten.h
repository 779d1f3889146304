#pragma once

#include <cstddef>
#include <string>

namespace affskel::server {

/// The text, cut at a character of UTF-8 and marked with "..." when it has more than `bytes` bytes: messages
/// quote what they are about, which may be megabytes.
inline std::string shortened(std::string text, std::size_t bytes) {
  if (text.size() <= bytes) return text;
  while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
  text.resize(bytes);
  return text + "...";
}

}  // namespace affskel::server

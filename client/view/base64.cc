#include "client/view/base64.h"

#include <cstdint>

namespace affskel::client {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

// Four digits for the 24 bits of a group.
void append_group(std::string& text, std::uint32_t bits) {
  for (int shift = 18; shift >= 0; shift -= 6) text.push_back(kDigits[(bits >> shift) & 63]);
}

}  // namespace

std::string base64(std::string_view bytes) {
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  const auto bits = [&](std::size_t at) -> std::uint32_t {
    return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : 0;
  };
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    append_group(text, bits(at) << 16 | bits(at + 1) << 8 | bits(at + 2));
  }
  const std::size_t missing = (3 - bytes.size() % 3) % 3;
  text.replace(text.size() - missing, missing, missing, '=');
  return text;
}

}  // namespace affskel::client

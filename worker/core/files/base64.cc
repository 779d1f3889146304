#include "core/files/base64.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace affskel::core {
namespace {

constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
constexpr std::int8_t kNoDigit = -1;

constexpr std::array<std::int8_t, 256> values_of_digits() {
  std::array<std::int8_t, 256> values{};
  values.fill(kNoDigit);
  for (std::size_t i = 0; i < kDigits.size(); ++i) {
    values[static_cast<unsigned char>(kDigits[i])] = static_cast<std::int8_t>(i);
  }
  return values;
}

// Four digits for the 24 bits of a group.
void append_group(std::string& text, std::uint32_t bits) {
  for (int shift = 18; shift >= 0; shift -= 6) text.push_back(kDigits[(bits >> shift) & 63]);
}

// Up to three bytes from the 24 bits of a group.
void append_bytes_of(std::string& bytes, std::uint32_t bits, int count) {
  for (int i = 0; i < count; ++i) bytes.push_back(static_cast<char>((bits >> (16 - 8 * i)) & 255));
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

std::optional<std::string> bytes_of_base64(std::string_view text) {
  static constexpr std::array<std::int8_t, 256> kValues = values_of_digits();
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 3);
  std::uint32_t bits = 0;
  int digits = 0, padding = 0;
  for (const char c : text) {
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    const std::int8_t value = kValues[static_cast<unsigned char>(c)];
    if (c == '=' ? digits < 2 : (value == kNoDigit || padding > 0)) return std::nullopt;
    padding += c == '=' ? 1 : 0;
    bits = bits << 6 | (c == '=' ? 0U : static_cast<std::uint32_t>(value));
    if (++digits < 4) continue;
    append_bytes_of(bytes, bits, 3 - padding);
    bits = 0;
    digits = padding = 0;
  }
  if (digits != 0) return std::nullopt;
  return bytes;
}

}  // namespace affskel::core

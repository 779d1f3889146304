#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace affskel::base {

/// Numbers that are stored and sent as bytes, least significant first on any machine (as in leveldb's
/// util/coding.h).
template <typename Number>
concept Codable = std::is_arithmetic_v<Number> && !std::same_as<Number, bool> && sizeof(Number) <= 8;

/// The number's bits, in the machine's order if they were least significant first, and the other way round.
template <std::unsigned_integral Bits>
constexpr Bits least_significant_first(Bits bits) {
  if constexpr (std::endian::native == std::endian::little) return bits;
  std::uint64_t reversed = 0;
  for (std::size_t i = 0; i < sizeof bits; ++i) reversed = reversed << 8 | (bits >> (8 * i) & 0xFF);
  return static_cast<Bits>(reversed);
}

/// The unsigned integer of the number's size.
template <Codable Number>
using BitsOf = std::conditional_t<
    sizeof(Number) == 8, std::uint64_t,
    std::conditional_t<sizeof(Number) == 4, std::uint32_t,
                       std::conditional_t<sizeof(Number) == 2, std::uint16_t, std::uint8_t>>>;

/// Puts the number's sizeof(Number) bytes at `to`.
template <Codable Number>
void encode(char* to, Number value) {
  const auto bits = least_significant_first(std::bit_cast<BitsOf<Number>>(value));
  std::memcpy(to, &bits, sizeof bits);
}

/// The number whose bytes are at `from`.
template <Codable Number>
Number decode(const char* from) {
  BitsOf<Number> bits;
  std::memcpy(&bits, from, sizeof bits);
  return std::bit_cast<Number>(least_significant_first(bits));
}

/// Adds the number's bytes.
template <Codable Number>
void append(std::string& bytes, Number value) {
  char raw[sizeof value];
  encode(raw, value);
  bytes.append(raw, sizeof raw);
}

}  // namespace affskel::base

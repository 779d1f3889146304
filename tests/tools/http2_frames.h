#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace affskel::tests::http2 {

// RFC 9113, sections 3.4 and 6.
constexpr std::string_view kPreface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
enum Type : std::uint8_t {
  kData = 0,
  kHeaders = 1,
  kPriority = 2,
  kReset = 3,
  kSettings = 4,
  kPing = 6,
  kWindowUpdate = 8,
  kContinuation = 9,
};
constexpr int kEndStream = 1;
constexpr int kAck = 1;
constexpr int kEndHeaders = 4;

/// A frame as it is sent.
inline std::string frame(int type, int flags, std::uint32_t stream, std::string_view contents = {}) {
  std::string bytes;
  const auto put = [&bytes](std::size_t value, int size) {
    for (int shift = 8 * (size - 1); shift >= 0; shift -= 8)
      bytes += static_cast<char>(value >> shift & 0xff);
  };
  put(contents.size(), 3);
  bytes += static_cast<char>(type);
  bytes += static_cast<char>(flags);
  put(stream, 4);
  return bytes += contents;
}

}  // namespace affskel::tests::http2

#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace affskel::client {

/// Bounds of the HTTP service; what exceeds them is closed or refused, so that nobody holds it for others.
struct HttpLimits {
  std::size_t connections = 256;  ///< at a time; of one address off this machine half as many
  /// Threads for answers that are quick, that compute here, and that wait for a worker; see AnswerKind.
  std::array<std::size_t, 3> threads = {8, 3, 24};
  std::size_t waiting = 64;  ///< answers of one kind under way or waiting; more get status 503
  std::uint32_t header_bytes = 16 * 1024;
  std::chrono::milliseconds header{
      10000};                             ///< from a connection's or request's first byte to the last header
  std::chrono::milliseconds idle{15000};  ///< a connection without requests is closed after this
  /// Bodies and answers must move `stretch_bytes` in every `stretch`.
  std::chrono::milliseconds stretch{20000};
  std::uint64_t stretch_bytes = 20 * 1024;
};

}  // namespace affskel::client

#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace affskel::wire {

/// Largest piece of bytes in one message of a stream.
inline constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

/// Largest number of field records in one message of a stream.
inline constexpr int kRecordsPerMessage = 32768;

/// Bytes of one record of a stored field: double E, double area, uint32 direction, little-endian.
inline constexpr std::size_t kFieldRecordBytes = 20;

/// Where a server listens: `unix:PATH` or `HOST:PORT`.
struct Address {
  bool is_unix = false;
  std::string path;  ///< of the socket, when is_unix
  std::string host;  ///< name or IP, without brackets, when not
  int port = 0;      ///< 0 = any free one (listening only)

  /// For gRPC: `unix:PATH`, `HOST:PORT` or `[V6]:PORT`.
  std::string target() const;
  /// Whether nobody outside this machine can reach it.
  bool is_local() const;
};

/// Parses `unix:PATH` (at most 107 bytes of path) or `HOST:PORT`, `[V6]:PORT`.
/// @throws std::invalid_argument with a message for people.
Address parse_address(std::string_view text);

}  // namespace affskel::wire

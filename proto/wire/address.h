#pragma once

#include <string>
#include <string_view>

namespace affskel::wire {

/// Where a server listens: `unix:PATH` or `HOST:PORT`.
struct Address {
  bool is_unix = false;
  std::string path;  ///< of the socket, when is_unix
  std::string host;  ///< name or IP, without brackets, when not
  int port = 0;      ///< 0 = any free one (listening only)

  /// For gRPC: `unix:PATH`, `HOST:PORT` or `[V6]:PORT`.
  std::string target() const;
  /// Whether only this machine can reach it.
  bool is_local() const;
};

/// Parses `unix:PATH` (at most 107 bytes of path) or `HOST:PORT`, `[V6]:PORT`.
/// @throws std::invalid_argument with a message for people.
Address parse_address(std::string_view text);

/// Whether a process accepts connections on the Unix socket at `path`; does not wait.
/// @throws std::runtime_error when this process can make no socket.
bool socket_answers(const std::string& path);

}  // namespace affskel::wire

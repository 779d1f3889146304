#pragma once

#include <string>

namespace affskel::tests {

struct HttpAnswer {
  int code = 0;
  std::string head;  ///< status line and headers
  std::string body;
};

/// Connects to "127.0.0.1:PORT".  @returns the socket, to be closed.  @throws std::runtime_error.
int connect_tcp(const std::string& address);

/// One request by a connection of its own, which the server is asked to close.
/// @throws std::runtime_error when no answer comes.
HttpAnswer http_get(const std::string& address, const std::string& path);

}  // namespace affskel::tests

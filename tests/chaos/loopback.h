#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>

#include <cstdint>

namespace affskel::chaos {

/// 127.0.0.1:PORT as the socket calls take it; port 0 is any free one.
inline sockaddr_in loopback(int port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  return address;
}

}  // namespace affskel::chaos

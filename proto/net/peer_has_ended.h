#pragma once

#include <poll.h>

namespace affskel::net {

/// Whether the peer of a connected socket has closed its side, whatever of it is still to be read.
inline bool peer_has_ended(int fd) {
  pollfd socket{fd, POLLRDHUP, 0};
  return poll(&socket, 1, 0) > 0;
}

}  // namespace affskel::net

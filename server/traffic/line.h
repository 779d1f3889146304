#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace affskel::server {

/// A connection, as the keepers of all of them see it.  Thread-safe.
class Line {
 public:
  virtual ~Line() = default;
  /// Hangs up, soon.
  virtual void hang_up() = 0;
  /// Bytes of messages that its peer has taken so far.
  virtual std::uint64_t answered() const = 0;
};

/// What becomes of a connection.  Called by the relay's threads.
struct LineEvents {
  /// The client speaks HTTP/2.
  /// @param socket the end of a pair of sockets for the HTTP/2 server, whose it is from now on.
  /// @param has_certificate the client has shown one, and it is good.
  std::function<void(int socket, bool has_certificate)> begun;
  /// It is about to be hung up on, and why.
  std::function<void(const std::string& why)> refused;
  /// Nothing of it is left; once, also when it did not begin.
  std::function<void()> ended;
};

/// A connection that has been accepted; closed when it is dropped before it starts.
class RelayLine : public Line {
 public:
  /// Call once.
  virtual void start(LineEvents events) = 0;
};

}  // namespace affskel::server

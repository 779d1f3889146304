#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>

#include "traffic/frame_guard.h"
#include "traffic/line.h"
#include "traffic/token_bucket.h"

namespace boost::asio::ssl {
class context;
}

namespace affskel::server {

struct RelayOptions {
  std::size_t threads = 2;
  std::chrono::milliseconds first{8000};  ///< for TLS and a client's first words
  std::chrono::milliseconds stall{
      20000};  ///< a peer that takes none of the bytes that wait for it is hung up on
  FrameLimits frames;
  std::size_t held_frames = 16384;  ///< FrameGuard::held_frames, of all connections
  /// Frames that make work (see FrameGuard) of a connection, of a peer and of all; of a peer and of all also
  /// new connections, and the calls that were under way when one was closed.
  TokenBucketOptions of_connection{.burst = 256, .per_s = 128};
  TokenBucketOptions of_peer{.burst = 1024, .per_s = 512};
  TokenBucketOptions of_all{.burst = 4096, .per_s = 2048};
  std::size_t newcomer =
      4;  ///< what a connection costs its peer, in such frames: gRPC takes 1 ms to begin one
  std::chrono::milliseconds longest_welcome{200};  ///< that a new connection waits for what its peer owes
  std::size_t free_calls = 8;                      ///< of a connection under way, and ...
  std::size_t free_frames = 16;  ///< ... frames lately, that do not wait for what others owe
};

/// Stands between clients' connections and gRPC's HTTP/2 server, which keeps without a bound what a client
/// sends faster than it can be worked off.  The relay speaks TLS, reads the frames of both directions
/// (FrameGuard), passes them on as they are, lets clients wait whose frames make more work than is due, and
/// hangs up on those that break the rules or take nothing.  Thread-safe.
class Relay {
 public:
  explicit Relay(const RelayOptions& options);
  ~Relay();
  Relay(const Relay&) = delete;
  Relay& operator=(const Relay&) = delete;

  /// @param socket connected, not blocking; the line's from now on.
  /// @param peer by whose name shares are counted.
  /// @param tls what it speaks TLS with; null = none.
  std::shared_ptr<RelayLine> take(int socket, const std::string& peer,
                                  std::shared_ptr<boost::asio::ssl::context> tls);

  /// Hangs up on peers that take nothing, or have not begun in time.  Call now and then.
  void tick();

  /// Hangs up on all, and ends the threads.
  void stop();

 private:
  class Connection;
  struct Shared;
  const std::unique_ptr<Shared> shared_;
};

}  // namespace affskel::server

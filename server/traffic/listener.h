#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "traffic/connections.h"
#include "traffic/rare_log.h"
#include "wire/address.h"

namespace affskel::server {

/// Takes connections for gRPC, whose own listening sockets are closed for good when the process runs out of
/// descriptors.  This one goes on when there is no room.
class Listener {
 public:
  /// Takes a connection, not blocking, which is its own from now on; false when there is no room for it.
  using Handler = std::function<bool(int connection, const PeerIdentity& peer)>;

  /// Binds; nothing is accepted yet.
  /// @param addresses see prepare_addresses.
  /// @param socket_mode permissions of Unix sockets.
  /// @throws std::runtime_error naming the address and the cause.
  Listener(const std::vector<wire::Address>& addresses, mode_t socket_mode);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Where it listens, with the ports actually bound.
  const std::vector<wire::Address>& addresses() const { return addresses_; }

  /// Starts a thread that hands connections to `handler`.
  void start(Handler handler);
  /// Closes the sockets, and removes those of the file system.
  void stop();

 private:
  void bind_unix(const wire::Address& address);
  void bind_tcp(wire::Address& address);
  void run();
  bool take(int listening);
  void log_refused(const std::string& why);
  void close_all();

  std::vector<wire::Address> addresses_;
  const mode_t socket_mode_;
  std::vector<int> sockets_;
  int wake_ = -1;
  Handler handler_;
  RareLog log_;
  std::thread thread_;
};

}  // namespace affskel::server

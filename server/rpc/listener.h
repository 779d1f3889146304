#pragma once

#include <sys/types.h>

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "rpc/connections.h"
#include "wire/address.h"

namespace affskel::server {

/// Takes connections for gRPC, whose own listening sockets are closed for good when the process runs out of
/// descriptors.  This one asks the table of connections whether there is room, and goes on when there is
/// none.
class Listener {
 public:
  /// @param is_tcp whether it came from another socket than one of the file system.
  using Handler = std::function<void(int connection, bool is_tcp)>;

  /// Binds; nothing is accepted yet.
  /// @param addresses see prepare_addresses.
  /// @param socket_mode permissions of Unix sockets.
  /// @param connections gets all of them, and decides; must outlive the listener.
  /// @throws std::runtime_error naming the address and the cause.
  Listener(const std::vector<wire::Address>& addresses, mode_t socket_mode, Connections& connections);
  ~Listener();
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;

  /// Where it listens, with the ports actually bound.
  const std::vector<wire::Address>& addresses() const { return addresses_; }

  /// Starts a thread that hands connections, not blocking, to `handler`, which owns them then.
  void start(Handler handler);
  /// Closes the sockets, and removes those of the file system.
  void stop();

 private:
  void bind_unix(const wire::Address& address);
  void bind_tcp(wire::Address& address);
  void run();
  bool take(int listening);
  void tell(const std::string& why);
  void close_all();

  std::vector<wire::Address> addresses_;
  Connections& connections_;
  const mode_t socket_mode_;
  std::vector<int> sockets_;
  int wake_ = -1;
  Handler handler_;
  std::int64_t refused_ = 0;  // of the thread: since it told of it
  std::int64_t told_ms_ = 0;  // of the thread: when, 0 = never
  std::thread thread_;
};

}  // namespace affskel::server

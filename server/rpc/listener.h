#pragma once

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "wire/address.h"

namespace affskel::server {

/// Takes connections for gRPC, whose own listening sockets are closed for good when the process runs out of
/// descriptors.  This one refuses connections while there are too many, and goes on.
class Listener {
 public:
  using Handler = std::function<void(int listening, int connection)>;

  /// Binds; nothing is accepted yet.
  /// @param addresses local ones: see prepare_addresses.
  /// @param first_refused a connection whose descriptor is this or more is closed at once.  Descriptors are
  ///   given out from the lowest, so that as many are in use then.
  /// @throws std::runtime_error naming the address and the cause.
  Listener(const std::vector<wire::Address>& addresses, int first_refused);
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
  const int first_refused_;
  std::vector<int> sockets_;
  int wake_ = -1;
  Handler handler_;
  std::int64_t refused_ = 0;  // of the thread: since it told of it
  std::int64_t told_ms_ = 0;  // of the thread: when, 0 = never
  std::thread thread_;
};

}  // namespace affskel::server

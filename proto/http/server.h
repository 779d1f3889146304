#pragma once

#include <functional>
#include <memory>

#include "http/limits.h"
#include "http/message.h"
#include "http/transport.h"
#include "wire/address.h"

namespace affskel::http {

/// What TLS needs for a new connection; called by the thread that serves, at every one.
using TlsContexts = std::function<std::shared_ptr<boost::asio::ssl::context>()>;

/// An HTTP/1.1 server, over TLS where there are contexts.  Asynchronous (Boost.Beast): a connection costs no
/// thread, and whole headers, bodies and answers have deadlines, not single reads.
class Server {
 public:
  /// Binds the address; connections are accepted by `run`.
  /// @param address HOST:PORT, port 0 takes any free one. @param tls empty = no TLS.
  /// @throws std::system_error when it cannot listen there.
  Server(const wire::Address& address, TlsContexts tls, AdmitRequest admit, Limits limits = {});
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  int port() const;

  /// Serves until `stop`, or, with `by_signal`, until SIGINT, SIGTERM or SIGHUP.  Answers under way are told
  /// to stop and waited for afterwards, by the destructor.
  void run(bool by_signal = false);
  /// Thread-safe.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace affskel::http

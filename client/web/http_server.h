#pragma once

#include <memory>
#include <string>

#include "client/web/http_limits.h"
#include "client/web/http_message.h"
#include "client/web/tls_identity.h"
#include "wire/address.h"

namespace affskel::client {

/// An HTTP/1.1 server, over TLS where there is an identity.  Asynchronous (Boost.Beast): a connection costs
/// no thread, and whole headers, bodies and answers have deadlines, not single reads.
class HttpServer {
 public:
  /// Binds the address; connections are accepted by `run`.
  /// @param address HOST:PORT, port 0 takes any free one.  @param identity null = no TLS; must outlive it.
  /// @throws ClientError kUsage when it cannot listen there.
  HttpServer(const wire::Address& address, TlsIdentity* identity, AdmitRequest admit, HttpLimits limits = {});
  ~HttpServer();
  HttpServer(const HttpServer&) = delete;
  HttpServer& operator=(const HttpServer&) = delete;

  int port() const;

  /// Serves until `stop`, or, with `by_signal`, until SIGINT, SIGTERM or SIGHUP.  Answers under way are
  /// waited for afterwards, by the destructor.
  void run(bool by_signal = false);
  /// Thread-safe.
  void stop();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace affskel::client

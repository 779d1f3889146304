#pragma once

#include <map>
#include <string>
#include <thread>

#include "http/server.h"

namespace affskel::http {

/// What came back.
struct PeerAnswer {
  int status = 0;                              ///< 0 = the connection ended without an answer
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
};

/// The other end of a connection, written over OpenSSL's BIO alone: it sends what it is told, byte for byte.
class Peer {
 public:
  explicit Peer(int port, bool tls = false);
  ~Peer();
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  /// @return false when the other end has closed.
  bool send(const std::string& bytes);
  /// The next answer, with Content-Length.
  PeerAnswer read();
  /// The same of one without a body.
  PeerAnswer read_head();
  /// Waits until the other end closes, passing over what comes.
  void wait_for_end();

 private:
  struct Connection;
  std::string line();

  std::unique_ptr<Connection> connection_;
};

/// A server on a loopback port, running in a thread.
class RunningServer {
 public:
  RunningServer(AdmitRequest admit, Limits limits = {}, TlsContexts tls = {}, bool by_signal = false)
      : server_(loopback(), std::move(tls), std::move(admit), limits),
        thread_([this, by_signal] { server_.run(by_signal); }) {}
  ~RunningServer() {
    server_.stop();
    thread_.join();
  }
  int port() const { return server_.port(); }

 private:
  static wire::Address loopback() {
    wire::Address address;
    address.host = "127.0.0.1";
    return address;
  }

  Server server_;
  std::thread thread_;
};

/// "GET /path HTTP/1.1" with a Host header and these more.
std::string get(const std::string& path, const std::string& more_headers = "");

}  // namespace affskel::http

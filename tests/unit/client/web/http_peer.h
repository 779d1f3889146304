#pragma once

#include <map>
#include <string>
#include <thread>

#include "client/web/http_server.h"

namespace affskel::client {

/// What came back.
struct PeerAnswer {
  int status = 0;                              ///< 0 = the connection ended without an answer
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
};

/// The other end of a connection, written over OpenSSL's BIO alone: it sends what it is told, byte for byte.
class HttpPeer {
 public:
  explicit HttpPeer(int port, bool tls = false);
  ~HttpPeer();
  HttpPeer(const HttpPeer&) = delete;
  HttpPeer& operator=(const HttpPeer&) = delete;

  /// @return false when the other end has closed.
  bool send(const std::string& bytes);
  /// The next answer, with Content-Length.
  PeerAnswer read();
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
  RunningServer(AdmitRequest admit, HttpLimits limits = {}, TlsIdentity* identity = nullptr)
      : server_(loopback(), identity, std::move(admit), limits), thread_([this] { server_.run(); }) {}
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

  HttpServer server_;
  std::thread thread_;
};

/// "GET /path HTTP/1.1" with a Host header and these more.
std::string get(const std::string& path, const std::string& more_headers = "");

}  // namespace affskel::client

#include "tools/http_peer.h"

#include <openssl/bio.h>
#include <openssl/ssl.h>

#include <algorithm>
#include <csignal>
#include <stdexcept>

namespace affskel::http {

struct Peer::Connection {
  SSL_CTX* context = nullptr;
  BIO* bio = nullptr;
  ~Connection() {
    BIO_free_all(bio);
    SSL_CTX_free(context);
  }
};

Peer::Peer(int port, bool tls) : connection_(std::make_unique<Connection>()) {
  std::signal(SIGPIPE, SIG_IGN);  // the service may close while it is written to
  const std::string place = "127.0.0.1:" + std::to_string(port);
  if (tls) {
    connection_->context = SSL_CTX_new(TLS_client_method());
    connection_->bio = BIO_new_ssl_connect(connection_->context);
    BIO_set_conn_hostname(connection_->bio, place.c_str());
  } else {
    connection_->bio = BIO_new_connect(place.c_str());
  }
  if (BIO_do_connect(connection_->bio) != 1) throw std::runtime_error("cannot connect to " + place);
}

Peer::~Peer() = default;

bool Peer::send(const std::string& bytes) {
  std::size_t sent = 0;
  while (sent < bytes.size()) {
    const int put = BIO_write(connection_->bio, bytes.data() + sent, static_cast<int>(bytes.size() - sent));
    if (put <= 0) return false;
    sent += static_cast<std::size_t>(put);
  }
  return BIO_flush(connection_->bio) == 1;
}

std::string Peer::line() {
  std::string text;
  char c = 0;
  while (BIO_read(connection_->bio, &c, 1) == 1 && c != '\n') {
    if (c != '\r') text += c;
  }
  return text;
}

PeerAnswer Peer::read_head() {
  PeerAnswer answer;
  const std::string first = line();
  if (first.size() < 12) return answer;
  answer.status = std::stoi(first.substr(9, 3));
  for (std::string header = line(); !header.empty(); header = line()) {
    const std::size_t colon = header.find(':');
    std::string name = header.substr(0, colon);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](char c) { return static_cast<char>(std::tolower(c)); });
    answer.headers[name] = header.substr(header.find_first_not_of(' ', colon + 1));
  }
  return answer;
}

PeerAnswer Peer::read() {
  PeerAnswer answer = read_head();
  const auto length = answer.headers.find("content-length");
  answer.body.resize(length == answer.headers.end() ? 0 : std::stoul(length->second));
  for (std::size_t at = 0; at < answer.body.size();) {
    const int got =
        BIO_read(connection_->bio, answer.body.data() + at, static_cast<int>(answer.body.size() - at));
    if (got <= 0) throw std::runtime_error("the answer was cut short");
    at += static_cast<std::size_t>(got);
  }
  return answer;
}

void Peer::wait_for_end() {
  char passed[4096];
  while (BIO_read(connection_->bio, passed, sizeof passed) > 0) {
  }
}

std::string get(const std::string& path, const std::string& more_headers) {
  return "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n" + more_headers + "\r\n";
}

}  // namespace affskel::http

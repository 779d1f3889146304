#include "wire/address.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

namespace affskel::wire {
namespace {

// sizeof(sockaddr_un::sun_path) - 1 on Linux.
constexpr std::size_t kMaxSocketPath = 107;

std::invalid_argument bad_address(std::string_view text, const std::string& why) {
  return std::invalid_argument("address '" + std::string(text) + "': " + why +
                               "; expected unix:PATH or HOST:PORT");
}

}  // namespace

std::string Address::target() const {
  if (is_unix) return "unix:" + path;
  const bool v6 = host.find(':') != std::string::npos;
  return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

bool Address::is_local() const {
  if (is_unix || host == "localhost" || host == "::1") return true;
  // All of 127/8, but only as an address: 127.example.org may be anywhere.
  in_addr address{};
  return inet_pton(AF_INET, host.c_str(), &address) == 1 && (ntohl(address.s_addr) >> 24) == 127;
}

Address parse_address(std::string_view text) {
  Address address;
  if (text.substr(0, 5) == "unix:") {
    address.is_unix = true;
    address.path = std::string(text.substr(5));
    if (address.path.substr(0, 2) == "//") address.path.erase(0, 2);
    if (address.path.empty()) throw bad_address(text, "the path is empty");
    if (address.path.size() > kMaxSocketPath) {
      throw bad_address(text, "a socket path has at most " + std::to_string(kMaxSocketPath) + " bytes");
    }
    return address;
  }
  if (text.find("://") != std::string_view::npos) throw bad_address(text, "that is a URL");
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) throw bad_address(text, "no port behind a host and a colon");
  std::string_view host = text.substr(0, colon);
  if (host.size() >= 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string_view::npos) {
    throw bad_address(text, "an IPv6 address needs brackets");
  }
  if (host.empty()) throw bad_address(text, "no host");
  const std::string_view port = text.substr(colon + 1);
  const auto [end, error] = std::from_chars(port.data(), port.data() + port.size(), address.port);
  if (error != std::errc{} || end != port.data() + port.size() || address.port < 0 || address.port > 65535) {
    throw bad_address(text, "the port must be 0 .. 65535");
  }
  address.host = std::string(host);
  return address;
}

bool socket_answers(const std::string& path) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  if (path.size() >= sizeof name.sun_path) return false;
  std::memcpy(name.sun_path, path.data(), path.size());
  const int fd = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) throw std::runtime_error(std::string("socket: ") + std::strerror(errno));
  const int result = connect(fd, reinterpret_cast<const sockaddr*>(&name), sizeof name);
  // EAGAIN: a live server whose queue is full.
  const bool answers = result == 0 || errno == EAGAIN || errno == EINPROGRESS;
  close(fd);
  return answers;
}

}  // namespace affskel::wire

#include "traffic/listener.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "base/logfmt.h"

namespace affskel::server {
namespace {

// Between tries when a connection cannot even be accepted: poll would come back at once, for it still waits.
constexpr int kPauseMs = 100;

// Clients that are refused come again and again.
constexpr std::chrono::minutes kLogEvery{1};

/// New sockets belong to this user alone, from the first moment on.
class PrivateFiles {
 public:
  PrivateFiles() : before_(umask(0177)) {}
  ~PrivateFiles() { umask(before_); }
  PrivateFiles(const PrivateFiles&) = delete;
  PrivateFiles& operator=(const PrivateFiles&) = delete;

 private:
  mode_t before_;
};

[[noreturn]] void refuse(const wire::Address& address, int error) {
  throw std::runtime_error("cannot listen on " + address.target() + ": " + std::strerror(error));
}

/// What a host's name or address stands for on this machine.
std::vector<sockaddr_storage> names_of(const wire::Address& address) {
  addrinfo hints{};
  hints.ai_flags = AI_PASSIVE;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (const int error = getaddrinfo(address.host.c_str(), nullptr, &hints, &found); error != 0) {
    throw std::runtime_error("cannot listen on " + address.target() + ": " + gai_strerror(error));
  }
  std::vector<sockaddr_storage> names;
  for (const addrinfo* one = found; one != nullptr; one = one->ai_next) {
    if (one->ai_family != AF_INET && one->ai_family != AF_INET6) continue;
    sockaddr_storage name{};
    std::memcpy(&name, one->ai_addr, one->ai_addrlen);
    names.push_back(name);
  }
  freeaddrinfo(found);
  // IPv4 first: its port is the one that is announced.
  std::stable_sort(names.begin(), names.end(), [](const auto& a, const auto& b) {
    return a.ss_family == AF_INET && b.ss_family != AF_INET;
  });
  return names;
}

/// By its address, whatever /etc/hosts says of it.
std::vector<sockaddr_storage> bound_names(const wire::Address& address) {
  if (address.host != "localhost") return names_of(address);
  wire::Address v4 = address, v6 = address;
  v4.host = "127.0.0.1";
  v6.host = "::1";
  std::vector<sockaddr_storage> names = names_of(v4);
  const std::vector<sockaddr_storage> more = names_of(v6);
  names.insert(names.end(), more.begin(), more.end());
  return names;
}

in_port_t& port_of(sockaddr_storage& name) {
  return name.ss_family == AF_INET ? reinterpret_cast<sockaddr_in&>(name).sin_port
                                   : reinterpret_cast<sockaddr_in6&>(name).sin6_port;
}

socklen_t size_of(const sockaddr_storage& name) {
  return name.ss_family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
}

void set(int fd, int level, int option) {
  const int on = 1;
  setsockopt(fd, level, option, &on, sizeof on);
}

/// A listening socket, or -1 with errno.
int listen_on(const sockaddr* name, socklen_t size) {
  const int fd = socket(name->sa_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (fd < 0) return -1;
  if (name->sa_family != AF_UNIX) {
    set(fd, SOL_SOCKET, SO_REUSEADDR);
    set(fd, IPPROTO_TCP, TCP_NODELAY);  // its connections have it from here
    if (name->sa_family == AF_INET6) set(fd, IPPROTO_IPV6, IPV6_V6ONLY);
  }
  if (bind(fd, name, size) == 0 && listen(fd, SOMAXCONN) == 0) return fd;
  const int error = errno;
  close(fd);
  errno = error;
  return -1;
}

}  // namespace

Listener::Listener(const std::vector<wire::Address>& addresses, mode_t socket_mode)
    : socket_mode_(socket_mode), log_(kLogEvery) {
  try {
    wake_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
    if (wake_ < 0) throw std::runtime_error(std::string("eventfd: ") + std::strerror(errno));
    for (wire::Address address : addresses) {
      if (address.is_unix) {
        bind_unix(address);
      } else {
        bind_tcp(address);
      }
      addresses_.push_back(std::move(address));
    }
  } catch (...) {
    close_all();
    throw;
  }
}

Listener::~Listener() {
  stop();
}

void Listener::bind_unix(const wire::Address& address) {
  sockaddr_un name{};
  name.sun_family = AF_UNIX;
  std::memcpy(name.sun_path, address.path.data(), std::min(address.path.size(), sizeof name.sun_path - 1));
  const PrivateFiles guard;
  const int fd = listen_on(reinterpret_cast<const sockaddr*>(&name), sizeof name);
  if (fd < 0) refuse(address, errno);
  sockets_.push_back(fd);
  if (chmod(address.path.c_str(), socket_mode_) != 0) refuse(address, errno);
}

void Listener::bind_tcp(wire::Address& address) {
  const bool any_port = address.port == 0;
  const std::size_t before = sockets_.size();
  for (sockaddr_storage name : bound_names(address)) {
    port_of(name) = htons(static_cast<std::uint16_t>(address.port));
    const int fd = listen_on(reinterpret_cast<const sockaddr*>(&name), size_of(name));
    if (fd < 0) {
      // A machine without IPv6 has no ::1; and a port found free for one family need not be for the other.
      const bool optional = name.ss_family == AF_INET6 && sockets_.size() > before;
      if (optional && (any_port || errno == EADDRNOTAVAIL || errno == EAFNOSUPPORT)) continue;
      refuse(address, errno);
    }
    sockets_.push_back(fd);
    socklen_t size = sizeof name;
    getsockname(fd, reinterpret_cast<sockaddr*>(&name), &size);
    address.port = ntohs(port_of(name));
  }
}

void Listener::start(Handler handler) {
  handler_ = std::move(handler);
  thread_ = std::thread([this] { run(); });
}

void Listener::stop() {
  if (thread_.joinable()) {
    eventfd_write(wake_, 1);
    thread_.join();
  }
  close_all();
}

void Listener::close_all() {
  for (int fd : sockets_) close(fd);
  sockets_.clear();
  if (wake_ >= 0) close(std::exchange(wake_, -1));
  for (const wire::Address& address : addresses_) {
    if (address.is_unix) unlink(address.path.c_str());
  }
  addresses_.clear();
}

void Listener::run() {
  std::vector<pollfd> waiting;
  for (int fd : sockets_) waiting.push_back({fd, POLLIN, 0});
  waiting.push_back({wake_, POLLIN, 0});
  for (;;) {
    if (poll(waiting.data(), waiting.size(), -1) < 0) continue;  // a signal
    if (waiting.back().revents != 0) return;
    bool more = true;
    for (const pollfd& one : waiting) {
      if (one.revents != 0) more = take(one.fd) && more;
    }
    if (!more) poll(&waiting.back(), 1, kPauseMs);
  }
}

/// One connection; false when none can be taken for want of something.
bool Listener::take(int listening) {
  const int fd = accept4(listening, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (fd >= 0) {
    try {
      if (!handler_(fd, peer_of(fd))) log_refused("too many connections and files are open");
      return true;
    } catch (const std::exception& error) {
      log_refused(error.what());
      return false;
    }
  }
  if (errno != EMFILE && errno != ENFILE && errno != ENOBUFS && errno != ENOMEM) return true;
  log_refused(std::strerror(errno));
  return false;
}

void Listener::log_refused(const std::string& why) {
  const auto number = log_.happened(std::chrono::steady_clock::now());
  if (number) spdlog::warn(base::logfmt("connections_refused", {{"number", *number}, {"message", why}}));
}

}  // namespace affskel::server

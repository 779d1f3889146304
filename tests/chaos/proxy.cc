#include "proxy.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <deque>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "loopback.h"

namespace affskel::chaos {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::size_t kQueue = std::size_t{1} << 20;
constexpr std::uint64_t kForever = ~std::uint64_t{0};

int connect_to(int port) {
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const sockaddr_in address = loopback(port);
  if (port == 0 || connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    close(fd);
    return -1;
  }
  fcntl(fd, F_SETFL, O_NONBLOCK);
  return fd;
}

void close_with_reset(int fd) {
  const linger at_once{1, 0};
  setsockopt(fd, SOL_SOCKET, SO_LINGER, &at_once, sizeof at_once);
  close(fd);
}

}  // namespace

/// One connection: two sockets, and what is on its way from each to the other.
struct Proxy::Link {
  struct Piece {
    Clock::time_point due;
    std::string bytes;
  };
  struct Way {
    int from, to;
    std::deque<Piece> queue;
    std::size_t queued = 0;
    bool ended = false;   // `from` sends nothing more
    bool closed = false;  // and `to` knows it
    Clock::time_point next_allowed{};
  };

  Link(int client, int server)
      : fds{client, server}, ways{Way{client, server, {}}, Way{server, client, {}}} {}
  ~Link() { finish(false); }

  void finish(bool reset) {
    if (std::exchange(done, true)) return;
    for (const int fd : fds) reset ? close_with_reset(fd) : static_cast<void>(close(fd));
  }

  void half(std::size_t way) {
    shutdown(ways[way].to, SHUT_WR);
    ways[way].ended = ways[way].closed = true;
    ways[way].queue.clear();
    ways[way].queued = 0;
  }

  /// Moves what can be moved along one way, and its end when all is through.
  void move(std::size_t which, bool can_take, bool can_give, const Weather& weather);
  void take(Way& way, const Weather& weather);
  void give(Way& way, const Weather& weather);
  void spend(std::uint64_t bytes);
  std::optional<Clock::time_point> next_give(const Way& way) const;

  std::array<int, 2> fds;
  std::array<Way, 2> ways;
  std::uint64_t left = kForever;  // bytes until it is reset
  bool done = false;
};

void Proxy::Link::take(Way& way, const Weather& weather) {
  std::array<char, 16384> buffer;
  const ssize_t got = recv(way.from, buffer.data(), buffer.size(), 0);
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (got < 0) return finish(true);
  if (got == 0) {
    way.ended = true;
    return;
  }
  if (weather.swallow) return;
  way.queue.push_back(
      {Clock::now() + weather.delay, std::string(buffer.data(), static_cast<std::size_t>(got))});
  way.queued += static_cast<std::size_t>(got);
}

void Proxy::Link::give(Way& way, const Weather& weather) {
  std::string& bytes = way.queue.front().bytes;
  // Slow connections pass a twentieth of a second's worth at a time.
  const std::uint64_t most =
      weather.bytes_per_second == 0 ? kForever : std::max<std::uint64_t>(1, weather.bytes_per_second / 20);
  const auto part = static_cast<std::size_t>(std::min<std::uint64_t>({bytes.size(), most, left}));
  const ssize_t sent = send(way.to, bytes.data(), part, MSG_NOSIGNAL);
  if (sent < 0 && (errno == EAGAIN || errno == EINTR)) return;
  if (sent < 0) return finish(true);
  if (weather.bytes_per_second != 0) way.next_allowed = Clock::now() + std::chrono::milliseconds(50);
  way.queued -= static_cast<std::size_t>(sent);
  bytes.erase(0, static_cast<std::size_t>(sent));
  if (bytes.empty()) way.queue.pop_front();
  spend(static_cast<std::uint64_t>(sent));
}

void Proxy::Link::move(std::size_t which, bool can_take, bool can_give, const Weather& weather) {
  Way& way = ways[which];
  if (!done && can_take) take(way, weather);
  if (!done && can_give && !way.queue.empty()) give(way, weather);
  if (!done && way.ended && !way.closed && way.queue.empty()) half(which);
  if (ways[0].closed && ways[1].closed) finish(false);
}

void Proxy::Link::spend(std::uint64_t bytes) {
  if (left == kForever) return;
  left -= bytes;
  if (left == 0) finish(true);
}

std::optional<Clock::time_point> Proxy::Link::next_give(const Way& way) const {
  if (way.queue.empty()) return std::nullopt;
  return std::max(way.queue.front().due, way.next_allowed);
}

Proxy::Proxy(std::function<int()> upstream) : upstream_(std::move(upstream)) {
  listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  event_ = eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK);
  sockaddr_in address = loopback(0);
  socklen_t length = sizeof address;
  if (bind(listener_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0 ||
      listen(listener_, 128) != 0 ||
      getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
    throw std::runtime_error("the proxy cannot listen");
  }
  port_ = ntohs(address.sin_port);
  thread_ = std::thread([this] { serve(); });
}

Proxy::~Proxy() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  wake();
  thread_.join();
  links_.clear();
  close(listener_);
  close(event_);
}

void Proxy::wake() const {
  const std::uint64_t one = 1;
  static_cast<void>(!write(event_, &one, sizeof one));
}

void Proxy::set(const Weather& weather) {
  {
    const std::lock_guard lock(mutex_);
    weather_ = weather;
  }
  wake();
}

void Proxy::end_all(End how) {
  {
    const std::lock_guard lock(mutex_);
    orders_.push_back([how](Link& link) {
      if (how == End::kHalfServer) return link.half(0);
      if (how == End::kHalfClient) return link.half(1);
      link.finish(how == End::kReset);
    });
  }
  wake();
}

void Proxy::cut_after(std::uint64_t bytes) {
  {
    const std::lock_guard lock(mutex_);
    orders_.push_back([bytes](Link& link) { link.left = std::max<std::uint64_t>(1, bytes); });
  }
  wake();
}

void Proxy::serve() {
  for (;;) {
    Weather weather;
    {
      const std::lock_guard lock(mutex_);
      if (stop_) return;
      weather = weather_;
      for (const auto& order : std::exchange(orders_, {})) {
        for (const auto& link : links_) order(*link);
      }
    }
    wait_for_events(weather);
    links_.remove_if([](const auto& link) { return link->done; });
    connections_ = links_.size();
  }
}

void Proxy::accept_one(const Weather& weather) {
  const int client = accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  if (client < 0) return;
  const int server = weather.refuse ? -1 : connect_to(upstream_());
  if (server < 0) return close_with_reset(client);
  links_.push_back(std::make_unique<Link>(client, server));
}

/// What to wait for on behalf of the links: pairs of entries, one to take from and one to give to.
struct Proxy::Wait {
  std::vector<pollfd> polled;
  std::vector<std::pair<Link*, std::size_t>> ways;  // of each pair: link, and which of its two ways
  std::optional<Clock::time_point> until;           // something is due then

  void add(Link& link, std::size_t which, const Weather& weather, Clock::time_point now) {
    const Link::Way& way = link.ways[which];
    const auto give = weather.hold ? std::nullopt : link.next_give(way);
    const bool due = give && *give <= now;
    if (give && !due) until = std::min(until.value_or(*give), *give);
    const bool more = !way.ended && !weather.hold && way.queued < kQueue;
    polled.push_back({more ? way.from : -1, POLLIN, 0});
    polled.push_back({due ? way.to : -1, POLLOUT, 0});
    ways.emplace_back(&link, which);
  }

  int timeout(Clock::time_point now) const {
    return until ? static_cast<int>(std::chrono::ceil<std::chrono::milliseconds>(*until - now).count()) : -1;
  }
};

void Proxy::wait_for_events(const Weather& weather) {
  const Clock::time_point now = Clock::now();
  Wait wait{{{listener_, POLLIN, 0}, {event_, POLLIN, 0}}, {}, {}};
  for (const auto& link : links_) {
    for (std::size_t which : {0U, 1U}) wait.add(*link, which, weather, now);
  }
  if (poll(wait.polled.data(), wait.polled.size(), wait.timeout(now)) < 0) return;
  for (std::size_t i = 0; i < wait.ways.size(); ++i) {
    const auto [link, which] = wait.ways[i];
    link->move(which, wait.polled[2 + 2 * i].revents != 0, wait.polled[3 + 2 * i].revents != 0, weather);
  }
  std::uint64_t count = 0;
  static_cast<void>(!read(event_, &count, sizeof count));
  if (wait.polled[0].revents != 0) accept_one(weather);
}

}  // namespace affskel::chaos

#include "traffic/relay.h"

#include <gtest/gtest.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <future>
#include <string>

#include "tools/http2_frames.h"

namespace affskel::server {
namespace {

using namespace tests::http2;
using std::chrono::milliseconds;

/// A descriptor that is closed.
class Socket {
 public:
  explicit Socket(int fd) : fd_(fd) {}
  Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Socket& operator=(Socket&&) = delete;
  ~Socket() {
    if (fd_ >= 0) close(fd_);
  }
  int fd() const { return fd_; }
  void send(const std::string& bytes) const {
    for (std::size_t sent = 0; sent < bytes.size();) {
      pollfd one{fd_, POLLOUT, 0};
      poll(&one, 1, -1);
      const ssize_t part = ::send(fd_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
      ASSERT_GT(part, 0);
      sent += static_cast<std::size_t>(part);
    }
  }
  /// As much as fits.
  void offer(const std::string& bytes) const { ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL); }
  bool has_bytes() const {
    pollfd one{fd_, POLLIN, 0};
    return poll(&one, 1, 0) > 0;
  }
  /// Waits for so many bytes, or the end.
  std::string read(std::size_t size) const {
    std::string bytes(size, '\0');
    std::size_t got = 0;
    while (got < size) {
      pollfd one{fd_, POLLIN, 0};
      poll(&one, 1, -1);
      const ssize_t part = recv(fd_, bytes.data() + got, size - got, 0);
      if (part <= 0) break;
      got += static_cast<std::size_t>(part);
    }
    return bytes.substr(0, got);
  }
  /// Waits until the other end is closed, whatever comes before.
  void wait_for_end() const {
    while (!read(65536).empty()) continue;
  }

 private:
  int fd_;
};

/// A client's connection through a relay.
struct Relayed {
  explicit Relayed(Relay& relay, const std::string& peer = "a") {
    int ends[2];
    EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
    client.emplace(ends[0]);
    line = relay.take(ends[1], peer, nullptr);
    const auto begun = [this](int socket, bool) { server.set_value(Socket(socket)); };
    const auto refused = [this](const std::string& text) { why = text; };
    const auto end = std::make_shared<std::promise<void>>();
    ended = end->get_future();
    line->start({begun, refused, [end] { end->set_value(); }});
  }
  ~Relayed() {
    client.reset();
    if (line != nullptr) line->hang_up();
    wait_for_end();
  }
  Relayed(const Relayed&) = delete;
  Relayed& operator=(const Relayed&) = delete;
  /// Waits until nothing is left of it.
  void wait_for_end() {
    line.reset();
    ended.wait();
  }

  std::optional<Socket> client;
  std::shared_ptr<RelayLine> line;
  std::promise<Socket> server;
  std::future<void> ended;
  std::string why;
};

const std::string kHello = std::string(kPreface) + frame(kSettings, 0, 0);

TEST(RelayTest, PassesOnWhatComes) {
  Relay relay({});
  Relayed one(relay);
  one.client->send(kHello.substr(0, 10));
  one.client->send(kHello.substr(10));
  const Socket server = one.server.get_future().get();
  EXPECT_EQ(server.read(kHello.size()), kHello);
  const std::string large = frame(kData, 0, 1, std::string(100000, 'd'));
  server.send(large);
  EXPECT_EQ(one.client->read(large.size()), large);
  one.client->send(large);
  EXPECT_EQ(server.read(large.size()), large);
}

TEST(RelayTest, EndsWithTheClient) {
  Relay relay({});
  Relayed one(relay);
  one.client->send(kHello);
  {
    const Socket server = one.server.get_future().get();
    one.client.reset();
    server.wait_for_end();
  }
  one.wait_for_end();
}

TEST(RelayTest, EndsWithTheServerWhenTheClientHasHeardItAll) {
  Relay relay({});
  Relayed one(relay);
  one.client->send(kHello);
  const std::string last = frame(kData, 0, 1, std::string(50000, 'd'));
  one.server.get_future().get().send(last);
  EXPECT_EQ(one.client->read(last.size() + 1), last);
  one.wait_for_end();
}

TEST(RelayTest, WhoBreaksTheRulesIsHungUpOn) {
  Relay relay({});
  Relayed one(relay);
  one.client->send(kHello + frame(kContinuation, 0, 1));
  one.client->wait_for_end();
  one.wait_for_end();
  EXPECT_EQ(one.why, "headers go on that have not begun");
}

TEST(RelayTest, WhoSaysNothingIsHungUpOn) {
  RelayOptions options;
  options.first = milliseconds(1);
  Relay relay(options);
  Relayed one(relay);
  auto ended = std::async([&] { one.client->wait_for_end(); });
  while (ended.wait_for(milliseconds(1)) != std::future_status::ready) relay.tick();
  one.wait_for_end();
  EXPECT_EQ(one.why, "it has said nothing") << "for the log";
}

TEST(RelayTest, WhoTakesNothingIsHungUpOn) {
  RelayOptions options;
  options.stall = milliseconds(1);
  Relay relay(options);
  Relayed one(relay);
  one.client->send(kHello);
  const Socket server = one.server.get_future().get();
  one.line.reset();
  // More than all buffers hold.
  const std::string piece = frame(kData, 0, 1, std::string(16384, 'd'));
  while (one.ended.wait_for(milliseconds(1)) != std::future_status::ready) {
    server.offer(piece);
    relay.tick();
  }
  EXPECT_EQ(one.why, "it takes nothing of what is sent to it") << "for the log";
}

/// Of one thread, so that what comes later is passed on later.
RelayOptions in_order() {
  RelayOptions options;
  options.threads = 1;
  return options;
}

/// When it returns, the relay has seen all that was sent before.
void let_pass(Relay& relay) {
  Relayed other(relay, "other");
  other.client->send(kHello);
  const Socket server = other.server.get_future().get();
  EXPECT_EQ(server.read(kHello.size()), kHello);
  other.client.reset();
  server.wait_for_end();
}

TEST(RelayTest, FramesThatMakeWorkWaitUntilTheyAreDue) {
  RelayOptions options = in_order();
  options.of_connection = {.burst = 10, .per_s = 1e-3};
  Relay relay(options);
  Relayed one(relay);
  const std::string ping = frame(kPing, 0, 0, "12345678");
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += ping;
  one.client->send(kHello + nine);
  const Socket server = one.server.get_future().get();
  EXPECT_EQ(server.read(kHello.size() + nine.size()), kHello + nine);
  one.client->send(ping);
  let_pass(relay);
  EXPECT_FALSE(server.has_bytes()) << "the eleventh is due in a quarter of an hour";
}

TEST(RelayTest, NewcomersWaitForWhatTheirPeerOwes) {
  RelayOptions options = in_order();
  options.of_peer = {.burst = 4, .per_s = 1e-3};
  options.newcomer = 4;
  options.longest_welcome = std::chrono::minutes(15);
  Relay relay(options);
  Relayed first(relay), second(relay);
  first.client->send(kHello);
  second.client->send(kHello);
  EXPECT_EQ(first.server.get_future().get().read(kHello.size()), kHello);
  let_pass(relay);
  EXPECT_NE(second.server.get_future().wait_for(milliseconds(0)), std::future_status::ready);
  second.line->hang_up();
}

TEST(RelayTest, WhoHasLeftIsNotBegun) {
  Relay relay({});
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends), 0);
  {
    const Socket client(ends[0]);
    client.send(kHello);
  }
  std::promise<void> ended;
  relay.take(ends[1], "a", nullptr)
      ->start({[](int socket, bool) {
                 close(socket);
                 ADD_FAILURE() << "begun";
               },
               nullptr, [&] { ended.set_value(); }});
  ended.get_future().wait();
}

TEST(RelayTest, CallsThatEndWithTheirConnectionAreOwed) {
  RelayOptions options = in_order();
  options.of_peer = {.burst = 20, .per_s = 1e-3};
  options.free_calls = 2;
  Relay relay(options);
  const auto call = [](std::uint32_t stream) { return frame(kHeaders, kEndHeaders, stream, "h"); };
  std::string calls;
  for (std::uint32_t stream = 1; stream < 60; stream += 2) calls += call(stream);
  {
    Relayed gone(relay);
    gone.client->send(kHello + calls);
    std::optional<Socket> server = gone.server.get_future().get();
    EXPECT_EQ(server->read(kHello.size() + calls.size()), kHello + calls);
    gone.client.reset();
    server->wait_for_end();
    server.reset();
    gone.wait_for_end();
  }
  Relayed same(relay), other(relay, "b");
  other.client->send(kHello + calls);
  const Socket theirs = other.server.get_future().get();
  EXPECT_EQ(theirs.read(kHello.size() + calls.size()), kHello + calls) << "others owe nothing";
  same.client->send(kHello + call(1) + call(3));
  const Socket server = same.server.get_future().get();
  const std::size_t free = kHello.size() + 2 * call(1).size();
  EXPECT_EQ(server.read(free).size(), free) << "a few calls are free";
  same.client->send(call(5));
  let_pass(relay);
  EXPECT_FALSE(server.has_bytes());
}

// What the system holds nothing can overtake.
TEST(RelayTest, LittleWaitsUnsentInTheSystem) {
  Relay relay({});
  const Socket client(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  const auto line = relay.take(dup(client.fd()), "a", nullptr);
  int most = 0;
  socklen_t size = sizeof most;
  ASSERT_EQ(getsockopt(client.fd(), IPPROTO_TCP, TCP_NOTSENT_LOWAT, &most, &size), 0);
  EXPECT_EQ(most, 128 << 10);
}

}  // namespace
}  // namespace affskel::server

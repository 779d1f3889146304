#include "rpc/connections.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <list>
#include <vector>

#include "rpc/status.h"
#include "service_fixture.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

/// Both ends of a connection.
class Pair {
 public:
  Pair() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends_), 0); }
  ~Pair() {
    close_server();
    close(ends_[1]);
  }
  Pair(const Pair&) = delete;
  Pair& operator=(const Pair&) = delete;
  int fd() const { return ends_[0]; }
  std::string name() const { return "fd:" + std::to_string(fd()); }
  void close_server() {
    if (ends_[0] >= 0) close(ends_[0]);
    ends_[0] = -1;
  }
  /// Whether the server's end was shut down.
  bool is_shut() const {
    char byte = 0;
    return recv(ends_[1], &byte, 1, MSG_PEEK) == 0;
  }

 private:
  int ends_[2] = {-1, -1};
};

class ConnectionsTest : public testing::Test {
 protected:
  /// A table with room for so many more connections.
  std::unique_ptr<Connections> table(int more) {
    const int lowest = dup(0);
    close(lowest);
    ConnectionOptions options;
    options.first_refused = lowest + 2 * more;  // a pair takes two descriptors
    options.spare = 16;
    options.most = 1000;
    options.now = [this] { return now_; };
    return std::make_unique<Connections>(options);
  }

  std::chrono::steady_clock::time_point now_ = std::chrono::steady_clock::now();
};

TEST_F(ConnectionsTest, KnowsWhoIsThere) {
  const Pair pair;
  const PeerIdentity peer = peer_of(pair.fd());
  EXPECT_EQ(peer.name, "uid:" + std::to_string(getuid()));
  EXPECT_EQ(peer.uid, getuid());
  const auto connections = table(4);
  ASSERT_TRUE(connections->admit(pair.fd(), peer));
  const Connections::Use first = connections->begin(pair.name(), Side::kClient);
  const Connections::Use second = connections->begin(pair.name(), Side::kClient);
  EXPECT_EQ(first.caller().connection, second.caller().connection);
  EXPECT_EQ(first.caller().peer, peer.name);
}

TEST_F(ConnectionsTest, ForgetsWhatIsClosed) {
  const auto connections = table(4);
  Pair pair;
  ASSERT_TRUE(connections->admit(pair.fd(), peer_of(pair.fd())));
  {
    const Connections::Use use = connections->begin(pair.name(), Side::kClient);
    pair.close_server();
    connections->sweep();
    EXPECT_EQ(connections->size(), 0U);
  }
  EXPECT_EQ(connections->size(), 0U) << "a call that ends later changes nothing";
}

TEST_F(ConnectionsTest, TheIdleGoFirstWhenDescriptorsAreShort) {
  const auto connections = table(3);
  Pair busy, used, silent;
  for (const Pair* pair : {&busy, &used, &silent}) {
    ASSERT_TRUE(connections->admit(pair->fd(), peer_of(pair->fd())));
  }
  const Connections::Use call = connections->begin(busy.name(), Side::kClient);
  { const Connections::Use ended = connections->begin(used.name(), Side::kClient); }
  const Pair next, after, last, more;
  EXPECT_FALSE(connections->admit(next.fd(), peer_of(next.fd()))) << "nobody has been idle for long";
  now_ += milliseconds(1000);
  EXPECT_TRUE(connections->admit(next.fd(), peer_of(next.fd())));
  EXPECT_TRUE(silent.is_shut()) << "who never made a call goes first";
  EXPECT_FALSE(used.is_shut());
  now_ += milliseconds(1000);
  EXPECT_TRUE(connections->admit(after.fd(), peer_of(after.fd())));
  EXPECT_TRUE(next.is_shut());
  now_ += milliseconds(1000);
  EXPECT_TRUE(connections->admit(last.fd(), peer_of(last.fd())));
  EXPECT_TRUE(connections->admit(more.fd(), peer_of(more.fd())) || used.is_shut());
  EXPECT_FALSE(busy.is_shut());
}

/// A table without regard to descriptors; numbers that are not open serve as connections.
constexpr int kNotOpen = 1 << 20;
ConnectionOptions of_most(std::size_t most, std::size_t for_workers) {
  ConnectionOptions options;
  options.first_refused = 2 * kNotOpen;
  options.most = most;
  options.for_workers = for_workers;
  return options;
}

TEST(ConnectionSharesTest, OnePeerLeavesAQuarterToOthers) {
  Connections connections(of_most(8, 0));
  int next = kNotOpen;
  for (int i = 0; i < 7; ++i) EXPECT_TRUE(connections.admit(next++, {"a"})) << "nobody else is there";
  EXPECT_TRUE(connections.admit(next++, {"b"}));
  EXPECT_FALSE(connections.admit(next++, {"a"}));
  EXPECT_TRUE(connections.admit(next++, {"b"}));
}

TEST(ConnectionSharesTest, AConnectionWithTlsIsFoundByItsSocket) {
  Connections connections(of_most(3, 1));
  ASSERT_TRUE(connections.admit(kNotOpen, {"ip:127.0.0.1", {}, "ipv4:127.0.0.1:4711"}));
  const Connections::Use use = connections.begin("ipv4:127.0.0.1:4711", Side::kClient);
  EXPECT_EQ(use.caller().peer, "ip:127.0.0.1");
  EXPECT_EQ(connections.calls(), 1u);
  EXPECT_EQ(connections.begin("ipv4:127.0.0.1:4712", Side::kClient).caller().peer, "ipv4:127.0.0.1:4712");
  EXPECT_EQ(connections.calls(), 1u) << "a stranger is not in the table";
  // The descriptor is another connection's by now, and so may the port be.
  ASSERT_TRUE(connections.admit(kNotOpen, {"ip:127.0.0.2", {}, "ipv4:127.0.0.2:1"}));
  EXPECT_NE(connections.begin("ipv4:127.0.0.1:4711", Side::kClient).caller().peer, "ip:127.0.0.1");
}

TEST(ConnectionSharesTest, WorkersHaveRoomOfTheirOwn) {
  Connections connections(of_most(3, 1));
  const auto name = [](int number) { return "fd:" + std::to_string(kNotOpen + number); };
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(connections.admit(kNotOpen + i, {"a"}));
  const Connections::Use one = connections.begin(name(0), Side::kClient);
  const Connections::Use two = connections.begin(name(1), Side::kClient);
  const auto begin = [&](int number, Side side) {
    return guarded([&] { connections.begin(name(number), side); });
  };
  EXPECT_EQ(begin(2, Side::kClient).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_TRUE(begin(2, Side::kWorker).ok());
  EXPECT_TRUE(begin(1, Side::kClient).ok()) << "who is connected stays so";
}

/// Connections that say nothing.
class Idlers {
 public:
  Idlers(const std::string& path, int count) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::memcpy(name.sun_path, path.data(), path.size());
    for (int i = 0; i < count; ++i) {
      fds_.push_back({socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0), POLLRDHUP, 0});
      EXPECT_EQ(connect(fds_.back().fd, reinterpret_cast<const sockaddr*>(&name), sizeof name), 0);
    }
  }
  ~Idlers() {
    for (const pollfd& one : fds_) close(one.fd);
  }
  /// Returns when one of them was hung up on.
  void wait_for_refusal() { EXPECT_GT(::poll(fds_.data(), fds_.size(), -1), 0); }
  /// Returns when all of them were.
  void wait_for_end() {
    for (pollfd& one : fds_) EXPECT_EQ(::poll(&one, 1, -1), 1);
  }

 private:
  std::vector<pollfd> fds_;
};

TEST_F(ServiceTest, ListensOnAfterTooManyConnections) {
  const int lowest = dup(0);
  close(lowest);
  options_.limits.connections = lowest + 60;
  start();
  const std::string id = submit();
  {
    Idlers idlers(options_.data_dir + "/server.sock", 100);
    idlers.wait_for_refusal();
    EXPECT_EQ(job(id).state(), v1::JOB_STATE_QUEUED) << "who is connected stays so";
  }
  const auto later = v1::ErosionService::NewStub(connect());
  grpc::ClientContext context;
  context.set_wait_for_ready(true);
  v1::ServerInfo info;
  EXPECT_TRUE(later->GetServerInfo(&context, {}, &info).ok());
}

TEST_F(ServiceTest, SilentConnectionsLockNobodyOut) {
  const int lowest = dup(0);
  close(lowest);
  options_.limits.connections = lowest + 200;
  options_.limits.idle = milliseconds(1000);
  start();
  Idlers idlers(options_.data_dir + "/server.sock", 150);
  const auto later = v1::ErosionService::NewStub(connect());
  grpc::ClientContext context;
  context.set_wait_for_ready(true);
  v1::ServerInfo info;
  EXPECT_TRUE(later->GetServerInfo(&context, {}, &info).ok());
  idlers.wait_for_end();
  while (server_->room().connections.size() > 3) std::this_thread::yield();
}

}  // namespace
}  // namespace affskel::server

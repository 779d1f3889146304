#include "traffic/connections.h"

#include "calls/status.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstring>
#include <map>
#include <vector>

#include "service_fixture.h"
#include "traffic/call_ended.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;

/// A connection that only says whether it was hung up on.
struct FakeLine : Line {
  void hang_up() override { is_shut = true; }
  std::uint64_t answered() const override { return 4711; }
  bool is_shut = false;
};

class ConnectionsTest : public testing::Test {
 protected:
  std::unique_ptr<Connections> table(std::size_t most, std::size_t for_workers = 0) {
    ConnectionOptions options;
    options.most = most;
    options.spare = 1;
    options.for_workers = for_workers;
    options.now = [this] { return now_; };
    return std::make_unique<Connections>(options);
  }

  /// Admits a connection that gRPC has by this socket; nothing when there is no room.
  std::shared_ptr<FakeLine> admit(Connections& connections, int socket, const std::string& peer = "a") {
    const auto line = std::make_shared<FakeLine>();
    const auto number = connections.admit({peer}, line);
    if (!number) return nullptr;
    connections.hand_over(*number, socket, false);
    numbers_[socket] = *number;
    return line;
  }

  std::chrono::steady_clock::time_point now_ = std::chrono::steady_clock::now();
  std::map<int, std::uint64_t> numbers_;
};

TEST(PeerTest, IsTheUserOrTheAddress) {
  int ends[2];
  ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends), 0);
  const PeerIdentity peer = peer_of(ends[0]);
  EXPECT_EQ(peer.name, "uid:" + std::to_string(getuid()));
  EXPECT_EQ(peer.uid, getuid());
  close(ends[0]);
  close(ends[1]);
  sockaddr_in6 name{};
  name.sin6_family = AF_INET6;
  inet_pton(AF_INET6, "2001:db8:1:2:aaaa:bbbb:cccc:dddd", &name.sin6_addr);
  EXPECT_EQ(peer_name(reinterpret_cast<const sockaddr&>(name)), "ip:2001:db8:1:2::/64")
      << "a host has as many addresses as it likes";
  name.sin6_addr = in6addr_loopback;
  EXPECT_EQ(peer_name(reinterpret_cast<const sockaddr&>(name)), "ip:::1");
}

TEST_F(ConnectionsTest, KnowsWhoIsThere) {
  const auto connections = table(4);
  const auto line = admit(*connections, 17, "uid:1000");
  const Connections::Call first = connections->begin("fd:17", Side::kClient);
  const Connections::Call second = connections->begin("fd:17", Side::kClient);
  EXPECT_EQ(first.caller().connection, second.caller().connection);
  EXPECT_EQ(first.caller().peer, "uid:1000");
  EXPECT_EQ(connections->calls(), 2u);
  EXPECT_EQ(connections->answered(first.caller().connection), 4711u);
  EXPECT_EQ(connections->begin("fd:18", Side::kClient).caller().peer, "fd:18");
  EXPECT_EQ(connections->calls(), 2u) << "a stranger is not in the table";
}

TEST_F(ConnectionsTest, ForgetsWhatIsClosed) {
  const auto connections = table(4);
  const auto line = admit(*connections, 17);
  {
    const Connections::Call use = connections->begin("fd:17", Side::kClient);
    // gRPC has closed its socket before, and the number is another connection's by now.
    const auto next = admit(*connections, 17, "b");
    connections->forget(use.caller().connection);
    EXPECT_EQ(connections->size(), 1u);
    EXPECT_FALSE(connections->answered(use.caller().connection));
    EXPECT_EQ(connections->begin("fd:17", Side::kClient).caller().peer, "b");
  }
  EXPECT_EQ(connections->size(), 1u) << "a call that ends later changes nothing";
}

TEST_F(ConnectionsTest, TheIdleGoFirstWhenThereIsNoRoom) {
  const auto connections = table(3);
  const auto busy = admit(*connections, 1), used = admit(*connections, 2), silent = admit(*connections, 3);
  const Connections::Call call = connections->begin("fd:1", Side::kClient);
  { const Connections::Call ended = connections->begin("fd:2", Side::kClient); }
  EXPECT_EQ(admit(*connections, 4), nullptr) << "nobody has been idle for long";
  now_ += milliseconds(1000);
  const auto next = admit(*connections, 4);
  ASSERT_NE(next, nullptr);
  EXPECT_TRUE(silent->is_shut) << "who never made a call goes first";
  EXPECT_FALSE(used->is_shut);
  EXPECT_EQ(admit(*connections, 5), nullptr) << "until the one that goes has gone";
  connections->forget(numbers_[3]);
  now_ += milliseconds(1000);
  ASSERT_NE(admit(*connections, 5), nullptr);
  EXPECT_TRUE(next->is_shut);
  connections->forget(numbers_[4]);
  EXPECT_FALSE(used->is_shut);
  EXPECT_FALSE(busy->is_shut);
}

TEST_F(ConnectionsTest, ALineMayEndWhileItIsHungUpOn) {
  const auto connections = table(1);
  struct LastHold : FakeLine {
    ~LastHold() override { table->forget(number); }
    void hang_up() override { mine->reset(); }
    Connections* table = nullptr;
    std::uint64_t number = 0;
    std::shared_ptr<LastHold>* mine = nullptr;
  };
  auto line = std::make_shared<LastHold>();
  line->table = connections.get();
  line->mine = &line;
  line->number = *connections->admit({"a"}, line);
  now_ += milliseconds(1000);
  EXPECT_NE(admit(*connections, 1), nullptr);
  EXPECT_EQ(connections->size(), 1u);
}

TEST_F(ConnectionsTest, OnePeerLeavesAQuarterToOthers) {
  const auto connections = table(8);
  for (int i = 0; i < 7; ++i) EXPECT_NE(admit(*connections, i), nullptr) << "nobody else is there";
  EXPECT_NE(admit(*connections, 7, "b"), nullptr);
  EXPECT_EQ(admit(*connections, 8), nullptr);
  connections->forget(numbers_[0]);
  EXPECT_NE(admit(*connections, 8, "b"), nullptr);
}

TEST_F(ConnectionsTest, WorkersHaveRoomOfTheirOwn) {
  const auto connections = table(3, 1);
  for (int i = 0; i < 3; ++i) ASSERT_NE(admit(*connections, i), nullptr);
  const Connections::Call one = connections->begin("fd:0", Side::kClient);
  const Connections::Call two = connections->begin("fd:1", Side::kClient);
  const auto begin = [&](const char* name, Side side) {
    return guarded([&] { connections->begin(name, side); });
  };
  EXPECT_EQ(begin("fd:2", Side::kClient).error_code(), grpc::StatusCode::UNAVAILABLE);
  EXPECT_TRUE(begin("fd:2", Side::kWorker).ok());
  EXPECT_TRUE(begin("fd:1", Side::kClient).ok()) << "who is connected stays so";
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
  options_.limits.connections = 60;
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
  options_.limits.connections = 200;
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

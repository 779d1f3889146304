#include "proxy.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <string>

#include "loopback.h"

namespace affskel::chaos {
namespace {

// A listener, the proxy before it, and a connection through both.
class ProxyTest : public testing::Test {
 protected:
  void SetUp() override {
    sockaddr_in address = loopback(0);
    socklen_t length = sizeof address;
    ASSERT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&address), length), 0);
    ASSERT_EQ(listen(listener_, 8), 0);
    ASSERT_EQ(getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &length), 0);
    port_ = ntohs(address.sin_port);
    proxy_ = std::make_unique<Proxy>([this] { return port_; });
    const sockaddr_in target = loopback(proxy_->port());
    ASSERT_EQ(connect(client_, reinterpret_cast<const sockaddr*>(&target), sizeof target), 0);
    server_ = accept(listener_, nullptr, nullptr);
    ASSERT_GE(server_, 0);
  }
  void TearDown() override {
    for (const int fd : {client_, server_, listener_}) close(fd);
  }

  static void say(int fd, const std::string& bytes) {
    ASSERT_EQ(send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL), static_cast<ssize_t>(bytes.size()));
  }
  // Until there are so many bytes or the other side has ended; an error as its number.
  static std::string hear(int fd, std::size_t bytes) {
    std::string heard;
    char byte = 0;
    while (heard.size() < bytes) {
      const ssize_t got = recv(fd, &byte, 1, 0);
      if (got < 0) return "error " + std::to_string(errno);
      if (got == 0) return heard + ".";
      heard += byte;
    }
    return heard;
  }

  int listener_ = socket(AF_INET, SOCK_STREAM, 0), client_ = socket(AF_INET, SOCK_STREAM, 0), server_ = -1;
  int port_ = 0;
  std::unique_ptr<Proxy> proxy_;
};

TEST_F(ProxyTest, PassesBytesAndEnds) {
  say(client_, "there");
  EXPECT_EQ(hear(server_, 5), "there");
  say(server_, "back");
  shutdown(server_, SHUT_WR);
  EXPECT_EQ(hear(client_, 9), "back.");
}

TEST_F(ProxyTest, Resets) {
  proxy_->end_all(Proxy::End::kReset);
  EXPECT_EQ(hear(client_, 1), "error " + std::to_string(ECONNRESET));
}

TEST_F(ProxyTest, ClosesOneDirectionAlone) {
  say(client_, "x");
  EXPECT_EQ(hear(server_, 1), "x");
  proxy_->end_all(Proxy::End::kHalfServer);
  EXPECT_EQ(hear(server_, 1), ".");
  say(server_, "y");
  EXPECT_EQ(hear(client_, 1), "y");
}

TEST_F(ProxyTest, CutsInTheMiddle) {
  proxy_->cut_after(3);
  say(client_, "abcdef");
  EXPECT_NE(hear(server_, 6), "abcdef");
}

TEST_F(ProxyTest, HoldsAndLetsGo) {
  proxy_->set({.hold = true});
  say(client_, "late");
  proxy_->set({});
  EXPECT_EQ(hear(server_, 4), "late");
}

}  // namespace
}  // namespace affskel::chaos

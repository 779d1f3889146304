#include "services/watchdog.h"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <future>

#include "service_fixture.h"

namespace affskel::server {
namespace {

constexpr WatchdogOptions kQuick{std::chrono::milliseconds(1), std::chrono::milliseconds(50), 3};

// Its socket takes connections, as a server's does that is half alive.
class DeafSocket {
 public:
  DeafSocket() : path_((directory_.path() / "s").string()), fd_(socket(AF_UNIX, SOCK_STREAM, 0)) {
    sockaddr_un name{};
    name.sun_family = AF_UNIX;
    std::strncpy(name.sun_path, path_.c_str(), sizeof name.sun_path - 1);
    if (bind(fd_, reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 || listen(fd_, 8) != 0) {
      throw std::runtime_error("cannot listen");
    }
  }
  ~DeafSocket() { close(fd_); }
  DeafSocket(const DeafSocket&) = delete;
  DeafSocket& operator=(const DeafSocket&) = delete;
  std::string target() const { return "unix:" + path_; }

 private:
  TemporaryDirectory directory_;
  std::string path_;
  int fd_;
};

TEST(WatchdogTest, TellsOfAServerThatNeverAnswers) {
  const DeafSocket socket;
  std::promise<void> deaf;
  const Watchdog watchdog(socket.target(), kQuick, [&] { deaf.set_value(); });
  EXPECT_EQ(deaf.get_future().wait_for(std::chrono::seconds(60)), std::future_status::ready);
}

// The channel went with the end of a call that came late, on a thread of gRPC that then joined itself.
TEST(WatchdogTest, EndsOnItsOwnThread) {
  const DeafSocket socket;
  const WatchdogOptions one_round{std::chrono::milliseconds(1), std::chrono::milliseconds(1), 1};
  for (int i = 0; i < 300; ++i) {
    std::promise<void> deaf;
    const Watchdog watchdog(socket.target(), one_round, [&] { deaf.set_value(); });
    ASSERT_EQ(deaf.get_future().wait_for(std::chrono::seconds(60)), std::future_status::ready) << i;
  }
}

class WatchdogServiceTest : public ServiceTest {};

// A strike needs a call without an answer; this server answers all of them.
TEST_F(WatchdogServiceTest, LeavesAServerAloneThatAnswers) {
  std::atomic<bool> deaf = false;
  {
    const WatchdogOptions patient{std::chrono::milliseconds(1), std::chrono::milliseconds(60000), 1};
    const Watchdog watchdog(server_->addresses().front().target(), patient, [&] { deaf = true; });
    submit();
  }
  EXPECT_FALSE(deaf);
}

}  // namespace
}  // namespace affskel::server

// Connections spoiled: those of the first worker and of every second call of the load, which go through the
// proxy, and connections of strangers straight to the server.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "faults.h"

namespace affskel::chaos {
namespace {

using Weather = Proxy::Weather;

bool weather_for(Scene& scene, const Weather& weather, Milliseconds time) {
  const bool any = scene.stage.proxy().connections() > 0;
  scene.stage.proxy().set(weather);
  last_for(time);
  scene.stage.proxy().set({});
  return any;
}

bool end_all(Scene& scene, Proxy::End how) {
  const bool any = scene.stage.proxy().connections() > 0;
  scene.stage.proxy().end_all(how);
  return any;
}

/// Connections to the server's TCP port that begin with given bytes, closed by the destructor.
class Strangers {
 public:
  Strangers(int port, std::size_t number, const std::function<std::string()>& greeting) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    for (std::size_t i = 0; i < number; ++i) {
      const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
      fds_.push_back(fd);
      if (connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) continue;
      const std::string bytes = greeting();
      connected_ += send(fd, bytes.data(), bytes.size(), MSG_NOSIGNAL) >= 0 ? 1 : 0;
    }
  }
  ~Strangers() {
    for (const int fd : fds_) close(fd);
  }
  Strangers(const Strangers&) = delete;
  Strangers& operator=(const Strangers&) = delete;
  bool any() const { return connected_ > 0; }

 private:
  std::vector<int> fds_;
  int connected_ = 0;
};

}  // namespace

bool net_delay(Scene& scene) {
  return weather_for(scene, {.delay = Milliseconds(100 + scene.pick(200))}, kLease);
}

bool net_throttle(Scene& scene) {
  return weather_for(scene, {.bytes_per_second = 4096}, kLease);
}

bool net_reset(Scene& scene) {
  return end_all(scene, Proxy::End::kReset);
}

bool net_cut(Scene& scene) {
  const bool any = scene.stage.proxy().connections() > 0;
  scene.stage.proxy().cut_after(1 + scene.pick(20000));
  last_for(Milliseconds(300));
  return any;
}

bool net_close(Scene& scene) {
  return end_all(scene, Proxy::End::kClose);
}

bool net_half_close(Scene& scene) {
  const bool any = end_all(scene, scene.pick(2) == 0 ? Proxy::End::kHalfServer : Proxy::End::kHalfClient);
  outlast_lease();
  scene.stage.proxy().end_all(Proxy::End::kReset);
  return any;
}

bool net_black_hole(Scene& scene) {
  const bool any = weather_for(scene, {.swallow = true}, kLease + Milliseconds(250));
  scene.stage.proxy().end_all(Proxy::End::kReset);
  return any;
}

bool net_partition(Scene& scene) {
  return weather_for(scene, {.hold = true}, kLease + Milliseconds(250));
}

bool net_refuse(Scene& scene) {
  scene.stage.proxy().set({.refuse = true});
  const bool any = end_all(scene, Proxy::End::kReset);
  outlast_lease();
  scene.stage.proxy().set({});
  return any;
}

bool garbage_connections(Scene& scene) {
  const Strangers strangers(scene.stage.port(), 30, [&] {
    std::string bytes = scene.pick(2) == 0 ? "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" : "";
    for (std::size_t length = 1 + scene.pick(4000); length > 0; --length) {
      bytes += static_cast<char>(scene.pick(256));
    }
    return bytes;
  });
  last_for(Milliseconds(200));
  return strangers.any();
}

bool silent_connections(Scene& scene) {
  const Strangers strangers(scene.stage.port(), 60, [] { return std::string(); });
  outlast_lease();
  return strangers.any();
}

bool idle_connections(Scene& scene) {
  const std::string preface = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";
  const std::string empty_settings("\0\0\0\4\0\0\0\0\0", 9);
  const Strangers strangers(scene.stage.port(), 200, [&] { return preface + empty_settings; });
  outlast_lease();
  return strangers.any();
}

}  // namespace affskel::chaos

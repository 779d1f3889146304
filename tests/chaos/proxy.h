#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace affskel::chaos {

/// A TCP proxy on a loopback port of its own with a thread that can spoil what passes.  Thread-safe.
class Proxy {
 public:
  /// What happens to the bytes of all connections, and to new ones.
  struct Weather {
    std::chrono::milliseconds delay{0};  ///< of every piece, both ways
    std::uint64_t bytes_per_second = 0;  ///< each way of each connection; 0 = as they come
    bool hold = false;                   ///< nothing passes until it is false again; nothing is lost
    bool swallow = false;                ///< what arrives is thrown away: the connection is of no use after
    bool refuse = false;                 ///< new connections are reset
  };

  /// How connections end.
  enum class End {
    kReset,       ///< RST to both sides
    kClose,       ///< orderly, both sides, with what was on its way lost
    kHalfServer,  ///< the server hears that the client sends nothing more; the client hears nothing
    kHalfClient,  ///< the client hears that the server sends nothing more; the server hears nothing
  };

  /// @param upstream the server's port of now, asked for every connection; 0 = there is none.
  explicit Proxy(std::function<int()> upstream);
  ~Proxy();

  int port() const { return port_; }
  void set(const Weather& weather);
  /// Ends all connections of now.
  void end_all(End how);
  /// Resets each connection of now after so many bytes more.
  void cut_after(std::uint64_t bytes);
  /// Connections of now.
  std::size_t connections() const { return connections_; }

 private:
  struct Link;
  struct Wait;

  void serve();
  void accept_one(const Weather& weather);
  void wait_for_events(const Weather& weather);
  void wake() const;

  std::function<int()> upstream_;
  int listener_ = -1, event_ = -1, port_ = 0;
  std::atomic<std::size_t> connections_{0};
  std::mutex mutex_;
  Weather weather_;
  std::vector<std::function<void(Link&)>> orders_;
  bool stop_ = false;
  std::list<std::unique_ptr<Link>> links_;  // of the thread alone
  std::thread thread_;
};

}  // namespace affskel::chaos

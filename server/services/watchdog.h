#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <stop_token>
#include <string>
#include <thread>

namespace affskel::server {

/// The lease that it renews and no worker has.
inline constexpr const char* kWatchdogToken = "watchdog";

struct WatchdogOptions {
  std::chrono::milliseconds period{5000};     ///< between two calls
  std::chrono::milliseconds patience{10000};  ///< for an answer, whatever it is
  int strikes = 3;                            ///< rounds in a row without one to each call
  std::size_t calls = 8;                      ///< of a round, at once
};

/// Calls the server as its workers do, through its socket, its threads and its store, and says when it does
/// not answer: gRPC may survive an allocation or a thread that it could not get, and then lose some of the
/// work that it hands to its threads, and with it a connection.  Several calls at once, for a connection at
/// rest hands over little.  The watchdog keeps its connection, so that it needs no descriptor when there are
/// none left.
class Watchdog {
 public:
  /// @param target where the server listens, as gRPC writes it.
  /// @param on_deaf called once, on the watchdog's thread.
  Watchdog(const std::string& target, const WatchdogOptions& options, std::function<void()> on_deaf);

 private:
  std::jthread thread_;
};

}  // namespace affskel::server

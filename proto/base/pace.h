#pragma once

#include <chrono>
#include <cstdint>

namespace affskel::base {

struct PaceOptions {
  std::chrono::milliseconds first{10000};   ///< longest wait for the peer's first message
  std::chrono::milliseconds window{20000};  ///< afterwards each stretch of waiting this long ...
  std::uint64_t least_per_s = 1024;         ///< ... must bring this many bytes a second on average
  std::chrono::milliseconds trial{1000};    ///< of waiting, before a peer is called slow at all
};

/// Whether the peer of a stream does its part fast enough.  Only the time counts in which it is the peer's
/// turn: a server that takes long does not make its clients slow.  Not thread-safe.
class Pace {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit Pace(const PaceOptions& options = {}) : options_(options) {}

  /// From now on the other side waits for the peer.
  void turn(Time now) {
    since_ = now;
    waiting_ = true;
  }

  /// The peer has done its part: sent or taken a message.
  void moved(std::uint64_t bytes, Time now) {
    waited_ = waited(now);
    waiting_ = false;
    bytes_ += bytes;
    total_ += bytes;
    begun_ = true;
    if (waited_ >= options_.window && enough()) {
      waited_ = {};
      bytes_ = 0;
    }
  }

  bool waiting() const { return waiting_; }

  /// Bytes so far.
  std::uint64_t total() const { return total_; }

  /// Whether it has had its time and used too little of it.
  bool late(Time now) const {
    if (!waiting_) return false;
    if (!begun_) return waited(now) >= options_.first;
    return now - since_ >= options_.window || (waited(now) >= options_.window && !enough());
  }

  /// Whether it has moved too little in the stretch that its last part has ended.
  bool fell_short() const { return waited_ >= options_.window && !enough(); }

  /// Whether it is slower than it should be, as far as can be seen; for when others need its place.
  bool slow(Time now) const {
    if (!judged(now)) return false;
    return !begun_ || rate(now) < static_cast<double>(options_.least_per_s);
  }

  /// Whether the other side has waited for it long enough to know its rate.
  bool judged(Time now) const { return waiting_ && waited(now) >= options_.trial; }

  /// Bytes a second lately.
  double rate(Time now) const {
    const double seconds = std::chrono::duration<double>(waited(now)).count();
    return static_cast<double>(bytes_) / (seconds > 0.001 ? seconds : 0.001);
  }

 private:
  using Duration = Time::duration;

  Duration waited(Time now) const { return waiting_ ? waited_ + (now - since_) : waited_; }
  bool enough() const {
    return static_cast<double>(bytes_) >=
           static_cast<double>(options_.least_per_s) * std::chrono::duration<double>(options_.window).count();
  }

  PaceOptions options_;
  Time since_{};
  bool waiting_ = false;
  bool begun_ = false;
  Duration waited_{};        // in this window, up to since_
  std::uint64_t bytes_ = 0;  // in this window
  std::uint64_t total_ = 0;
};

}  // namespace affskel::base

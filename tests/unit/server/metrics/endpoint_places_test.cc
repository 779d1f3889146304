#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <list>
#include <memory>

#include "http/places.h"
#include "metrics/endpoint.h"

namespace affskel::server {
namespace {

using std::chrono::milliseconds;
using Time = http::Places::Clock::time_point;

constexpr milliseconds kAgain{50};     // an attacker whose connection was closed comes again
constexpr milliseconds kNetwork{200};  // from when an honest peer connects until its request comes
constexpr milliseconds kTick{1};

// The places of an endpoint at a time of its own.  Attackers that never ask anything come again and again, and every
// 50 ms an honest peer.  They wait in one queue, as the kernel's.
class Siege {
 public:
  explicit Siege(std::size_t attackers) : places_(limits_of({}).places, [this] { return now_; }) {
    for (std::size_t i = 0; i < attackers; ++i) come(false);
  }

  void last(milliseconds time) {
    for (const Time end = now_ + time; now_ < end; now_ += kTick) {
      if (now_.time_since_epoch() % milliseconds(50) == milliseconds(0)) come(true);
      while (!again_.empty() && again_.front() <= now_) {
        again_.pop_front();
        come(false);
      }
      admit();
      answer();
      leave();
    }
  }

  std::size_t answered = 0;
  std::size_t turned_away = 0;  // honest ones
  milliseconds longest{0};      // until an honest one is answered

 private:
  struct Peer {
    bool honest;
    Time came;
    bool closed = false;
    std::unique_ptr<http::Places::Place> place = nullptr;
  };

  void come(bool honest) { queue_.push_back({honest, now_}); }

  void admit() {
    while (!queue_.empty() && places_.pause() == http::Places::Clock::duration::zero()) {
      Peer& peer = connected_.emplace_back(std::move(queue_.front()));
      queue_.pop_front();
      peer.place = places_.take("192.0.2.1", [&peer] { peer.closed = true; });
      if (peer.place == nullptr) peer.closed = true;
    }
  }

  void answer() {
    for (Peer& peer : connected_) {
      if (!peer.honest || peer.closed || now_ < peer.came + kNetwork) continue;
      longest = std::max(longest, std::chrono::duration_cast<milliseconds>(now_ - peer.came));
      ++answered;
      peer.place.reset();
    }
  }

  void leave() {
    for (auto peer = connected_.begin(); peer != connected_.end();) {
      const auto gone = peer++;
      if (gone->place != nullptr && !gone->closed) continue;
      if (gone->closed && gone->honest) ++turned_away;
      if (!gone->honest) again_.push_back(now_ + kAgain);
      connected_.erase(gone);
    }
  }

  Time now_{};
  http::Places places_;
  std::deque<Peer> queue_;
  std::list<Peer> connected_;
  std::deque<Time> again_;
};

// Few attackers fill the places without a queue, in which a peer's request could come before its turn does.
TEST(EndpointPlacesTest, WhoAsksAcrossASlowNetworkIsHeardWhileOthersComeAndGo) {
  for (const std::size_t attackers : {50U, 100U, 150U, 200U, 300U, 400U, 500U}) {
    Siege siege(attackers);
    siege.last(std::chrono::seconds(5));
    EXPECT_GT(siege.answered, 50U) << attackers;
    EXPECT_EQ(siege.turned_away, 0U) << attackers;
    EXPECT_LT(siege.longest, std::chrono::seconds(1)) << attackers;
  }
}

}  // namespace
}  // namespace affskel::server

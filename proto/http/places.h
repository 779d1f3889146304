#pragma once

#include <boost/asio/ip/address.hpp>
#include <chrono>
#include <functional>
#include <list>
#include <memory>
#include <string>

#include "http/limits.h"

namespace affskel::http {

/// Whom shares are counted by: "192.0.2.1", of IPv4-mapped addresses, too; "2001:db8::/64" of IPv6, of which
/// one host has so many.
std::string peer_key(const boost::asio::ip::address& address);

/// All connections of a server: whose they are, and which of them do nothing.  A newcomer for whom there is
/// no room takes the place of another.  Those of known owners go last.  Of the others first go those that
/// never made a request, then those idle for longest, then those just answered, then those that have just
/// come or whose request or answer is on its way, for longest, and at last those whose answer has been
/// waited for for longest.  Strangers at one address have at most half of the places while others are
/// connected.  Not thread-safe.
class Places {
 public:
  using Clock = std::chrono::steady_clock;
  class Place;

  explicit Places(PlaceLimits limits, std::function<Clock::time_point()> now = Clock::now)
      : limits_(limits), now_(std::move(now)) {}

  /// How long newcomers are to wait to be accepted: until who would give way to them has stayed long enough.
  Clock::duration pause();

  /// For a new connection.
  /// @param peer see peer_key. @param close is called, once at most, to give the place to another.
  /// @return null when there is no room.
  std::unique_ptr<Place> take(const std::string& peer, std::function<void()> close);

  /// Connections that were not told to close.
  std::size_t size() const;

 private:
  enum class Stage { kIdle, kTransfer, kWork };
  struct Entry {
    std::string peer;
    std::function<void()> close;
    Clock::time_point came;
    Clock::time_point since;  // when the stage began
    Stage stage = Stage::kIdle;
    std::string owner = {};  // empty = a stranger's
    bool used = false;       // a request was answered
    bool closing = false;    // told to
  };
  using Entries = std::list<Entry>;
  using Choice = std::function<bool(const Entry&)>;

  static bool is_stranger(const Entry& entry) { return entry.owner.empty(); }
  std::size_t count(const Choice& choice) const;
  int rank(const Entry& entry) const;
  std::size_t most_strangers() const;
  Entry* next_to_go(const Choice& choice);
  bool close_one(const Choice& choice);

  const PlaceLimits limits_;
  const std::function<Clock::time_point()> now_;
  Entries entries_;
};

/// The place of one connection, until it is destroyed.  It begins idle.
class Places::Place {
 public:
  Place(Places& places, Entries::iterator entry) : places_(places), entry_(entry) {}
  ~Place() { places_.entries_.erase(entry_); }
  Place(const Place&) = delete;
  Place& operator=(const Place&) = delete;

  /// Of the last request: an owner that is known, or, empty, a stranger.
  /// @return false when they have their share of places already, and use all of them.
  bool belongs_to(const std::string& owner);
  /// From now on the peer's next request is waited for.
  void idles();
  /// From now on a body comes or an answer goes.
  void transfers();
  /// From now on the server makes the answer.
  void works();

 private:
  void begin(Stage stage);

  Places& places_;
  Entries::iterator entry_;
};

}  // namespace affskel::http

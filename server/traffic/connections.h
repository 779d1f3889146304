#pragma once

#include <sys/socket.h>
#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "access/rules.h"
#include "base/mutex.h"
#include "traffic/caller.h"
#include "traffic/line.h"

namespace affskel::server {

/// The peer at the other end of a connection, as the system knows it.
struct PeerIdentity {
  /// "uid:1000" on a Unix socket, "ip:127.0.0.1" or "ip:2001:db8::/64" on TCP; shares are counted by it.
  std::string name;
  std::optional<uid_t> uid = {};  ///< of its process, on a Unix socket
};

/// The name of a peer at an address of IPv4 or IPv6; a host has all those of its network of 64 bits.
std::string peer_name(const sockaddr& address);

/// @param fd a connected socket.
PeerIdentity peer_of(int fd);

struct ConnectionOptions {
  std::size_t most = 0;   ///< connections at once
  std::size_t spare = 0;  ///< beyond those, while one that was told to close goes
  /// Of the connections, so many can only be used for workers' calls.
  std::size_t for_workers = 0;
  std::chrono::milliseconds grace{1000};  ///< a connection idle for less than this is left alone
  std::function<std::chrono::steady_clock::time_point()> now = [] {
    return std::chrono::steady_clock::now();
  };
};

/// All connections of a server: whose they are, and which of them do nothing.  When there are too many, the
/// idle ones go first: those that never made a call, then those idle for longest.  No peer has
/// more than three quarters of them while others are connected.  Thread-safe.
class Connections {
 public:
  explicit Connections(ConnectionOptions options) : options_(std::move(options)) {}

  /// A call under way on a connection, until it is destroyed.
  class Call {
   public:
    Call() = default;
    Call(Connections* table, Caller caller) : table_(table), caller_(std::move(caller)) {}
    Call(Call&& other) noexcept;
    Call& operator=(Call&& other) noexcept;
    ~Call() { leave(); }
    const Caller& caller() const { return caller_; }
    /// The gate has identified it: from now on shares are counted by owner, if a token said so.
    void identify(const Identity& identity);

   private:
    void leave();
    Connections* table_ = nullptr;
    Caller caller_;
  };

  /// Enters a new connection.
  /// @param identity of its peer.
  /// @return its number; nothing when there is no room: close it.
  std::optional<std::uint64_t> admit(const PeerIdentity& identity, const std::weak_ptr<Line>& line);

  /// gRPC has it now.
  /// @param socket by which gRPC names it.
  void hand_over(std::uint64_t connection, int socket, bool has_certificate);

  /// It is closed.
  void forget(std::uint64_t connection);

  /// A call begins.
  /// @param peer as gRPC names it: "fd:N".  One that is not known is its own connection and peer.
  /// @throws CallEnded UNAVAILABLE for a client's call when the clients have all connections but those for
  ///   workers.
  Call begin(const std::string& peer, Side side);

  /// Bytes of messages that the peer of a connection has taken so far; nothing when it is closed.
  std::optional<std::uint64_t> answered(std::uint64_t connection) const;

  std::size_t size() const;
  /// Calls under way on all of them.
  std::size_t calls() const;

 private:
  using Time = std::chrono::steady_clock::time_point;
  struct Entry {
    PeerIdentity identity;
    std::weak_ptr<Line> line;
    Time idle_since;
    int socket = -1;  // gRPC's
    bool has_certificate = false;
    std::size_t calls = 0;
    bool used = false;        // made a call
    bool for_client = false;  // made a client's call
    bool for_worker = false;  // made a worker's call
    bool closing = false;     // told to
  };
  using Entries = std::map<std::uint64_t, Entry>;  // by number

  using Lines = std::vector<std::shared_ptr<Line>>;

  bool close_idle(const std::string* of_peer, Lines& going) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool has_room(const PeerIdentity& identity, Lines& going) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Entries::iterator find(const std::string& peer) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void end_call(std::uint64_t connection);

  const ConnectionOptions options_;
  mutable base::Mutex mutex_;
  Entries entries_ ABSL_GUARDED_BY(mutex_);
  std::map<int, std::uint64_t> by_socket_ ABSL_GUARDED_BY(mutex_);
  // Connections that made clients' calls, and none of a worker.
  std::size_t clients_ ABSL_GUARDED_BY(mutex_) = 0;
  std::uint64_t next_number_ ABSL_GUARDED_BY(mutex_) = 1;
};

}  // namespace affskel::server

#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "access/rules.h"
#include "base/mutex.h"
#include "rpc/call_limit.h"

namespace affskel::server {

/// Who is at the other end of a connection, as the system knows it.
struct PeerIdentity {
  std::string name;  ///< "uid:1000" on a Unix socket, "ip:127.0.0.1" on TCP; shares are counted by it
  std::optional<uid_t> uid = {};  ///< of its process, on a Unix socket
  std::string socket_name =
      {};  ///< "ipv4:127.0.0.1:4711", as gRPC names TCP connections that it handshakes with
};

/// @param fd a connected socket.
PeerIdentity peer_of(int fd);

struct ConnectionOptions {
  int first_refused = 0;  ///< descriptors are given out from the lowest: as many are in use then
  std::size_t most = 0;   ///< connections at once, as shares are counted
  int spare = 0;          ///< beyond those, while one that was told to close goes
  /// Of the connections, so many can only be used for workers' calls.
  std::size_t for_workers = 0;
  std::chrono::milliseconds grace{1000};  ///< a connection idle for less than this is left alone
  std::function<std::chrono::steady_clock::time_point()> now = [] {
    return std::chrono::steady_clock::now();
  };
};

/// All connections of a server, by descriptor: whose they are, and which of them do nothing.  When there are
/// too many, the idle ones go first: those that never made a call, then those idle for longest.  No peer has
/// more than three quarters of them while others are connected.  Thread-safe.
class Connections {
 public:
  explicit Connections(ConnectionOptions options) : options_(std::move(options)) {}

  /// A call under way on a connection, until it is destroyed.
  class Use {
   public:
    Use() = default;
    Use(Connections* table, Caller caller) : table_(table), caller_(std::move(caller)) {}
    Use(Use&& other) noexcept;
    Use& operator=(Use&& other) noexcept;
    ~Use() { leave(); }
    const Caller& caller() const { return caller_; }
    /// The gate has found who it is: from now on shares are counted by owner, if a token said so.
    void identify(const Identity& identity);

   private:
    void leave();
    Connections* table_ = nullptr;
    Caller caller_;
  };

  /// Enters a new connection, whose end is noticed by itself.  Calls of admit() never overlap.
  /// @param identity of its peer.
  /// @return false when there is no room: close it.
  bool admit(int fd, const PeerIdentity& identity);

  /// A call begins.
  /// @param peer as gRPC names it: "fd:N", or by its socket_name.  One that is not known is its own
  /// connection
  ///   and peer.
  /// @throws CallEnded UNAVAILABLE for a client's call when the clients have all connections but those for
  ///   workers.
  Use begin(const std::string& peer, Side side);

  /// Forgets connections that are closed.  Call now and then.
  void sweep();

  std::size_t size() const;
  /// Calls under way on all of them.
  std::size_t calls() const;

 private:
  using Time = std::chrono::steady_clock::time_point;
  struct Entry {
    std::uint64_t number;
    std::uint64_t inode;
    PeerIdentity identity;
    Time idle_since;
    std::size_t calls = 0;
    bool used = false;        // made a call
    bool for_client = false;  // made a client's call
    bool for_worker = false;  // made a worker's call
    bool closing = false;     // told to
  };
  using Entries = std::map<int, Entry>;  // by descriptor

  void sweep_locked() ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool close_idle(const std::string* of_peer) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  bool has_room(int fd, const PeerIdentity& identity) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Entries::iterator find(const std::string& peer) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  Entries::iterator forget(Entries::iterator entry) ABSL_EXCLUSIVE_LOCKS_REQUIRED(mutex_);
  void end_use(std::uint64_t connection);

  const ConnectionOptions options_;
  mutable base::Mutex mutex_;
  Entries entries_ ABSL_GUARDED_BY(mutex_);
  std::map<std::uint64_t, int> by_number_ ABSL_GUARDED_BY(mutex_);
  std::map<std::string, int> by_socket_name_ ABSL_GUARDED_BY(mutex_);
  std::size_t clients_ ABSL_GUARDED_BY(mutex_) =
      0;  // connections that made clients' calls, and none of a worker
  std::uint64_t next_number_ ABSL_GUARDED_BY(mutex_) = 1;
};

}  // namespace affskel::server

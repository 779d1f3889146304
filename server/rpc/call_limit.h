#pragma once

#include <grpcpp/server_context.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <list>
#include <mutex>
#include <string>

namespace affskel::server {

/// How many calls that hold a thread, memory or open files a server has under way at once, and how many
/// connections.
struct CallLimits {
  std::size_t downloads = 64;  ///< artefacts being sent; each has the database and its log open
  std::size_t uploads = 64;    ///< meshes being received
  std::size_t waiting = 256;   ///< calls that wait for an artefact or for their turn; each holds a thread
  std::size_t watches = 4096;  ///< WatchJob streams
  std::chrono::milliseconds patience{5000};  ///< how long a download or an upload waits for its turn
  std::chrono::milliseconds stall{30000};    ///< without progress a call may lose its place to another
  int connections = 0;                       ///< a connection whose descriptor is this or more is refused
};

/// What a process may have open, shared out: workers, the database and downloads keep descriptors that
/// connections cannot take.
/// @param open_files limit on descriptors, at least 1.
CallLimits limits_for(std::uint64_t open_files);

/// The limit on descriptors of this process.
std::uint64_t open_files_limit();

/// Places for calls of one kind.  Who finds none waits for a while, or takes that of a call that has made no
/// progress for long: a client that reads nothing would keep it for ever.  Thread-safe.
class CallLimit {
  struct Holder {
    grpc::ServerContextBase* context;  // null: must not be ended
    std::chrono::steady_clock::time_point progress;
  };

 public:
  /// @param what the calls, plural, for messages.
  CallLimit(std::string what, std::size_t most, std::chrono::milliseconds patience,
            std::chrono::milliseconds stall)
      : what_(std::move(what)), most_(most), patience_(patience), stall_(stall) {}

  /// A place of one call, from construction to destruction; used by one thread.
  class Place {
   public:
    /// @throws CallEnded UNAVAILABLE when there is none.
    explicit Place(CallLimit& limit);
    ~Place();
    Place(const Place&) = delete;
    Place& operator=(const Place&) = delete;

    /// From now on the call depends on its client; if that does nothing for long, the place may be lost and
    /// the call, whose context this is, cancelled.
    void depend_on_client(grpc::ServerContextBase& context);
    /// The call got further.
    void progress();

   private:
    CallLimit& limit_;
    Holder holder_;
  };

 private:
  bool enter(Holder& holder);
  bool evict(std::chrono::steady_clock::time_point now);

  const std::string what_;
  const std::size_t most_;
  const std::chrono::milliseconds patience_;
  const std::chrono::milliseconds stall_;
  std::mutex mutex_;
  std::condition_variable freed_;
  std::list<Holder*> holders_;  // guarded by mutex_, and so is what they point to
};

}  // namespace affskel::server

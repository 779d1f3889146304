#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "affskel/v1/client_service.grpc.pb.h"
#include "tools/temporary_directory.h"

namespace affskel::integration {

/// A process of our own; killed at the latest by the destructor.
class Process {
 public:
  /// Starts `arguments[0]`; stdout and stderr go to `log` (appended).
  /// @param environment "NAME=value" entries on top of the present environment.
  Process(const std::vector<std::string>& arguments, const std::string& log,
          const std::vector<std::string>& environment = {});
  ~Process();
  Process(Process&& other) noexcept;
  Process& operator=(Process&& other) noexcept;

  pid_t pid() const { return pid_; }
  /// Whether it has not ended yet.
  bool running() const;
  void send(int signal) const;

  /// Waits for the end: the exit code, or 128 + signal.
  int wait();

  /// SIGKILL, then wait.
  void kill_hard();

 private:
  pid_t pid_ = -1;
};

struct Output {
  int exit_code = 0;
  std::string out;
  std::string err;
};

/// Why a test that mounts is skipped, and what would let it run.
inline constexpr const char* kCannotMount =
    "a small disk is a tmpfs in a mount namespace of its own, which this user may not make; to run this, "
    "allow user namespaces (sysctl kernel.unprivileged_userns_clone=1; in a container a seccomp profile with "
    "unshare and mount), install unshare (util-linux), and where the root is a plain chroot mount it on itself "
    "first (mount --bind ROOT ROOT)";

/// The real programs in a directory of their own, removed at the end.
class Lab {
 public:
  Lab();
  ~Lab();

  std::string path(const std::string& name) const { return dir_ / name; }
  std::string address() const { return "unix:" + path("s.sock"); }
  /// Where the server of path("data") tells its metrics.  @throws when it does not.
  std::string metrics_address() const;
  std::string read(const std::string& name) const;
  void write(const std::string& name, const std::string& bytes) const;

  /// Starts affskel-server on address() with the data directory path("data") and waits until it answers.
  Process server(const std::vector<std::string>& options = {}) const;
  /// The same where data directory and everything else in path("disk") share so many bytes.  Only this server
  /// sees what is in there.
  Process server_on_small_disk(const std::string& size, const std::vector<std::string>& options = {}) const;
  /// A command that has path("disk") to itself, with limits as tmpfs takes them: "size=100m", "nr_inodes=5".
  std::vector<std::string> on_small_disk(const std::string& limits,
                                         const std::vector<std::string>& command) const;
  /// Whether this process may do that.
  bool can_mount() const;
  Process worker(const std::vector<std::string>& options = {}) const;

  /// Runs affskel-client against address() to its end.
  Output client(const std::vector<std::string>& arguments) const;
  /// Makes a torus of so many triangles as path("m.off").  @throws std::runtime_error.
  void make_torus(int triangles) const;
  /// Submits path("m.off").  @returns the job's id.  @throws std::runtime_error with what the client says.
  std::string submit(const std::vector<std::string>& options) const;
  /// Runs any of the programs to its end.
  Output run(const std::vector<std::string>& arguments,
             const std::vector<std::string>& environment = {}) const;

  /// The job as the server knows it.  Waits for a server that is just starting.
  v1::Job job(const std::string& id) const;

  /// The one worker that gave all of the job's field.
  v1::Giver only_giver(const std::string& id) const;

  /// Follows the job until the condition holds or it is in a final state; returns it as it was then.
  /// Re-attaches when the server goes away and comes back.
  v1::Job follow(const std::string& id, const std::function<bool(const v1::Job&)>& condition) const;
  /// Until this share of its directions is done.
  v1::Job follow_to_share(const std::string& id, double share) const;
  v1::Job follow_to_end(const std::string& id) const;

  v1::ErosionService::Stub& stub() const { return *stub_; }

 private:
  void wait_for_server() const;

  tests::TemporaryDirectory dir_;
  std::unique_ptr<v1::ErosionService::Stub> stub_;
};

}  // namespace affskel::integration

#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "api.h"
#include "catalogue.h"
#include "control.h"
#include "process.h"
#include "proxy.h"
#include "tools/test_authority.h"

namespace affskel::chaos {

constexpr Milliseconds kLease{1500};  ///< of the servers here: what "beyond the lease" means
constexpr std::size_t kWorkers = 2;

/// A control page in a file, mapped here and in the process that it is for.
class ControlFile {
 public:
  explicit ControlFile(const std::string& path);
  ~ControlFile();
  ControlFile(const ControlFile&) = delete;
  ControlFile& operator=(const ControlFile&) = delete;
  Control& operator*() const { return *control_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  Control* control_;
};

/// Callers by TCP show a token of this owner: clients, a user's; workers, a worker's.
constexpr const char* kClientOwner = "chaos";
constexpr const char* kWorkerOwner = "crew";

/// A server and two workers as processes, the first worker behind a proxy.  TCP callers show tokens.  For the
/// driver's main thread.
class Stage {
 public:
  /// @param dir for sockets and logs.
  /// @param data_dir of the server.
  /// @param tls whether TCP speaks TLS.
  Stage(const Programs& programs, const std::string& dir, const std::string& data_dir, bool tls = false);

  void start_server();
  void start_worker(std::size_t which);
  void start_workers();
  /// Waits until the server answers.  @throws Hang, or Died when it ended instead.
  void wait_for_server();
  /// Waits until each worker was heard from within a lease.  @throws Hang.
  void wait_for_workers();

  /// Makes a new token for an owner; callers with his file show it from now on.
  void renew_token(const std::string& owner);
  /// Revokes the one that he has.
  void revoke_token(const std::string& owner) const;
  /// What is shown to the server on TCP.
  wire::AccessFiles access_of(const std::string& owner) const;

  /// Takes all troubles of clock, files and network away.
  void calm();
  /// Starts again what has ended; returns what that was, with the exit code.
  std::vector<std::string> restart_dead();
  /// Kills all and starts all: after a hang.
  void start_over();

  Process& server() { return server_; }
  Process& worker(std::size_t which) { return workers_.at(which); }
  Control& server_control() { return **controls_[0]; }
  Control& worker_control(std::size_t which) { return **controls_.at(which + 1); }
  Proxy& proxy() { return *proxy_; }

  const Api& api() const { return api_; }           ///< straight to the server
  const Api& proxied() const { return *proxied_; }  ///< by way of the proxy
  std::string address() const { return "unix:" + dir_ + "/s.sock"; }
  std::string path(const std::string& name) const { return dir_ + "/" + name; }
  const std::string& data_dir() const { return data_dir_; }
  const Programs& programs() const { return programs_; }
  /// The server's TCP port of now; 0 when it is not known.
  int port() const;
  /// `affskel-server check` of the data directory: nothing when it is clean, else what it says.
  std::string check(const std::string& data_dir) const;

 private:
  std::string token_command(std::vector<std::string> arguments) const;
  Process start(std::vector<std::string> arguments, const std::string& log, std::size_t control) const;

  Programs programs_;
  std::string dir_, data_dir_;
  std::unique_ptr<tests::TestAuthority> authority_;  // of TLS, if there is any
  std::map<std::string, std::string> token_ids_;     // by owner
  std::array<std::unique_ptr<ControlFile>, kWorkers + 1> controls_;
  Process server_;
  std::array<Process, kWorkers> workers_;
  std::unique_ptr<Proxy> proxy_;
  Api api_;
  std::unique_ptr<Api> proxied_;
};

}  // namespace affskel::chaos

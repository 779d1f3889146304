#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "affskel/v1/client_service.pb.h"
#include "store/tx.h"

namespace affskel::server {

/// What affskel-server is asked for.
enum class Command { kServe, kCheck, kBackup, kMigrate, kTokenAdd, kTokenList, kTokenRevoke, kTrust };

/// The command line of affskel-server, checked for form.
struct Options {
  Command command = Command::kServe;
  std::string data_dir;
  std::vector<std::string> listen;  ///< empty = unix:DATA_DIR/server.sock
  unsigned socket_mode = 0600;      ///< permissions of Unix sockets
  std::string tls_cert;             ///< PEM; empty = no TLS
  std::string tls_key;
  std::string tls_client_ca;
  bool insecure = false;
  std::string metrics;  ///< where metrics are told; empty = nowhere
  unsigned workers = 0;
  std::string worker_binary;    ///< empty = next to this program, else on the PATH
  unsigned worker_threads = 0;  ///< 0 = the cores shared out among the workers
  std::optional<double> idle_exit_s;
  std::int64_t lease_ms = 5000;
  std::int64_t report_interval_ms = 1000;
  std::uint64_t max_mesh_mb = 1024;
  OwnerOrder owner_order = OwnerOrder::kFirstCome;
  Policy policy;
  std::string log_level = "info";
  bool json = false;                            ///< of the commands: one JSON document instead of lines
  bool repair = false;                          ///< of check
  std::string output;                           ///< of backup and token add
  bool force = false;                           ///< of backup
  std::string owner;                            ///< of token add
  v1::Role role = v1::ROLE_USER;                ///< of token add
  std::optional<std::chrono::seconds> expires;  ///< of token add: from now on; absent = never
  std::int64_t token = 0;                       ///< of token revoke: its id
  std::string trusted;                          ///< of trust: a host or a worker
};

/// Parses the command line.  Prints help, version or what is wrong; then `exit_code` is set: 0 or 2.
struct ParsedOptions {
  Options options;
  std::optional<int> exit_code;
};
ParsedOptions parse_options(int argc, char** argv);

}  // namespace affskel::server

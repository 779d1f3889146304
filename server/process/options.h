#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "store/tx.h"

namespace affskel::server {

/// What affskel-server is asked for.
enum class Command { kServe, kCheck, kBackup, kMigrate };

/// The command line of affskel-server, checked for form.
struct Options {
  Command command = Command::kServe;
  std::string data_dir;
  std::vector<std::string> listen;  ///< empty = unix:DATA_DIR/server.sock
  unsigned workers = 0;
  std::string worker_binary;    ///< empty = next to this program, else on the PATH
  unsigned worker_threads = 0;  ///< 0 = the cores shared out among the workers
  std::optional<double> idle_exit_s;
  std::int64_t lease_ms = 5000;
  std::int64_t report_interval_ms = 1000;
  std::uint64_t max_mesh_mb = 1024;
  OwnerOrder owner_order = OwnerOrder::kFirstCome;
  std::string log_level = "info";
  bool json = false;    ///< of the commands: one JSON document instead of lines
  bool repair = false;  ///< of check
  std::string output;   ///< of backup
  bool force = false;   ///< of backup
};

/// Parses the command line.  Prints help, version or what is wrong; then `exit_code` is set: 0 or 2.
struct ParsedOptions {
  Options options;
  std::optional<int> exit_code;
};
ParsedOptions parse_options(int argc, char** argv);

}  // namespace affskel::server

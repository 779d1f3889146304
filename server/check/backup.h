#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace affskel::server {

struct BackupOptions {
  bool force = false;  ///< replace a file that is there
  /// Asked every few megabytes; false breaks off.
  std::function<bool()> go_on = [] { return true; };
};

struct Backup {
  bool complete = false;  ///< false = broken off, and nothing was written
  std::int64_t bytes = 0;
  int schema = 0;
};

/// Copies the database of a data directory to the file `target`, whether a server runs there or not: all that
/// was committed before the call, as of one moment.  The file appears complete and synced, or not at all, and
/// is readable by this user alone.  As affskel.db in an empty directory it is a data directory again: a
/// server makes everything else anew.
/// @throws StoreError kUnusable when there is no database of affskel-server, kInvalid for a target in the
///   data directory; std::system_error about the target, EEXIST when it is there without `force`;
///   SqliteError.
Backup back_up(const std::string& data_dir, const std::string& target, const BackupOptions& options = {});

}  // namespace affskel::server

#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "store/sqlite.h"

namespace affskel::server {

struct StoreOptions {
  std::int64_t lease_ms = 5000;            ///< a lease ends when its worker is silent for this long
  std::int64_t report_interval_ms = 1000;  ///< what workers are told
  std::int64_t max_losses = 5;  ///< leases lost in a row, without progress, before a task is given up
  std::uint64_t max_mesh_bytes = std::uint64_t{1} << 30;
};

/// What a committed transaction changed, for those who wait.
struct Changes {
  std::set<std::string> jobs;    ///< ids of changed jobs
  bool work = false;             ///< a task became available
  std::vector<std::string> log;  ///< key=value lines
};

/// Hears of committed changes.  Called without the store's lock, on the thread that changed something;
/// must return quickly.
class ChangeListener {
 public:
  virtual ~ChangeListener() = default;
  virtual void on_change(const Changes& changes) = 0;
};

/// An open write transaction, handed to the functions of the store's rooms.  The times were taken after
/// the write lock was held.
struct Tx {
  Database& db;
  const StoreOptions& options;
  std::int64_t wall_ms;
  std::int64_t lease_ms;
  Changes& changes;
};

}  // namespace affskel::server

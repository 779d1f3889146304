#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "database/disk_reserve.h"
#include "database/sqlite.h"
#include "store/policy.h"

namespace affskel::server {

/// How the jobs of one owner share what the owner is granted.
enum class OwnerOrder {
  kFirstCome,   ///< oldest first: they are done one after the other, each as early as it can be
  kRoundRobin,  ///< their blocks in turn: all go on at once, and none is done early
};
class Metrics;

struct StoreOptions {
  OwnerOrder owner_order = OwnerOrder::kFirstCome;
  Policy policy;
  std::int64_t lease_ms = 5000;            ///< a lease ends when its worker is silent for this long
  std::int64_t report_interval_ms = 1000;  ///< what workers are told
  std::int64_t max_losses = 5;  ///< leases lost in a row, without progress, before a task is given up
  /// A block of directions is taken back when so long, or a long time for its job, none of them was finished.
  std::int64_t stall_ms = 120'000;
  /// The same for tasks that cannot tell of progress: to prepare and to derive.
  std::int64_t long_stall_ms = std::int64_t{24} * 3600 * 1000;
  std::int64_t max_leases_held = 4;  ///< by one worker
  /// A request for an artefact from before a restart is taken back when no client has asked again by then.
  std::int64_t orphan_grace_ms = 10'000;
  std::uint64_t max_mesh_bytes = std::uint64_t{1} << 30;
  /// Kept back on the disk so that jobs can be cancelled and deleted when it is full.
  std::uint64_t reserve_bytes = std::uint64_t{16} << 20;
  DiskReserve::FreeBytes free_bytes = affskel::server::free_bytes;
};

/// What a committed transaction changed, for those that wait.
struct Changes {
  std::set<std::string> jobs;    ///< ids of changed jobs
  bool work = false;             ///< a task became available
  bool dropped = false;          ///< something is left for Store::tidy
  bool grown = false;            ///< more than bookkeeping was written
  bool partly = false;           ///< of that, a part of what has to be written whole
  bool refused = false;          ///< more than bookkeeping was to be written, and the disk is full
  bool eased = false;            ///< a job that was short of room no longer needs it
  std::vector<std::string> log;  ///< entries: base::logfmt
  /// What the metrics are told.
  std::vector<std::function<void(Metrics&)>> counts;
  /// Tasks whose workers brought what is more than bookkeeping, and their jobs.
  std::map<std::int64_t, std::string> results;
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
  bool room;  ///< false on a full disk: only what frees space, or takes next to none, may be written

  /// Before more than bookkeeping is written.  @throws SqliteError with SQLITE_FULL when there is no room.
  void require_room();
};

}  // namespace affskel::server

// A disk that is full, or is to be less so.
//
// Three things together let users recover by cancelling and deleting jobs.  Whatever is committed has its
// place in the database file (Database::claim_pages), so that the log can always be copied there and begun
// anew.  A reserve (DiskReserve) is given away when a write finds the disk full: from then on it serves
// bookkeeping only (Tx::room), until there is room to make it anew.  And deleting takes little of the log:
// what is left of a job goes piece by piece, each a transaction, the log copied after every one.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "base/logfmt.h"
#include "base/mutex.h"
#include "store/job_life.h"
#include "store/space.h"
#include "store/store_impl.h"

namespace affskel::server {
namespace {

constexpr std::int64_t kTryAgainMs = 60000;

// The log of a full disk is copied as soon as it has this much, for it must not grow.
constexpr std::int64_t kFullDiskLogBytes = std::int64_t{1} << 18;

// Rows deleted in a step: some 5 to 16 MiB.  A report that was logged can be as large as that by itself.
constexpr int kFieldChunks = 64;
constexpr int kRefinedChunks = 24;
constexpr int kMegabyteChunks = 8;
constexpr int kLoggedReports = 8;

// Pages given back in a step; each may have to be moved.
constexpr int kPagesGivenBack = 128;

// Largest content of an old database that is rewritten when it is opened.
constexpr std::int64_t kQuicklyRewritten = std::int64_t{128} << 20;

}  // namespace

SqliteError full_disk(const Database& db) {
  return {SQLITE_FULL, "the server's disk is full (" + db.file() +
                           "): delete jobs that are no longer needed, or make room otherwise"};
}

void Tx::require_room() {
  changes.refused = !room;
  if (!room) throw full_disk(db);
  changes.grown = true;
}

bool delete_piece(Tx& tx) {
  if (const std::optional<std::int64_t> erosion =
          tx.db.integer("SELECT id FROM erosions WHERE dropped = 1 LIMIT 1")) {
    const auto gone = [&](const char* sql, int rows) { return tx.db.run(sql, *erosion, rows) > 0; };
    if (gone("DELETE FROM field_chunks WHERE id IN"
             " (SELECT id FROM field_chunks WHERE erosion_id = ? LIMIT ?)",
             kFieldChunks) ||
        gone("DELETE FROM field_log WHERE id IN (SELECT id FROM field_log WHERE erosion_id = ? LIMIT ?)",
             kLoggedReports) ||
        gone("DELETE FROM refined_chunks WHERE id IN"
             " (SELECT id FROM refined_chunks WHERE erosion_id = ? LIMIT ?)",
             kRefinedChunks) ||
        gone("DELETE FROM refined_log WHERE id IN (SELECT id FROM refined_log WHERE erosion_id = ? LIMIT ?)",
             kLoggedReports) ||
        gone("DELETE FROM artifact_chunks WHERE rowid IN"
             " (SELECT c.rowid FROM artifacts a JOIN artifact_chunks c ON c.artifact_id = a.id"
             "  WHERE a.erosion_id = ? LIMIT ?)",
             kMegabyteChunks)) {
      return true;
    }
    tx.db.run(
        "INSERT INTO dropped_meshes (sha256) SELECT e.mesh_sha256 FROM erosions e WHERE e.id = ?1"
        " AND NOT EXISTS (SELECT 1 FROM erosions WHERE mesh_sha256 = e.mesh_sha256 AND id <> ?1)"
        " AND NOT EXISTS (SELECT 1 FROM repairs WHERE source_sha256 = e.mesh_sha256)",
        *erosion);
    tx.db.run("DELETE FROM erosions WHERE id = ?", *erosion);
    return true;
  }
  Statement dropped = tx.db.query("SELECT sha256 FROM dropped_meshes LIMIT 1");
  if (!dropped.step()) return false;
  const std::string mesh = dropped.text(0);
  if (tx.db.run("DELETE FROM mesh_chunks WHERE rowid IN"
                " (SELECT rowid FROM mesh_chunks WHERE sha256 = ? LIMIT ?)",
                mesh, kMegabyteChunks) == 0) {
    tx.db.run("DELETE FROM meshes WHERE sha256 = ?", mesh);
  }
  return true;
}

bool give_pages_back(Database& db) {
  // Files of older versions cannot shrink.
  if (db.integer("PRAGMA auto_vacuum") == 0 || db.integer("PRAGMA freelist_count") == 0) return false;
  static const std::string vacuum = "PRAGMA incremental_vacuum(" + std::to_string(kPagesGivenBack) + ")";
  db.run(vacuum.c_str());
  return true;
}

void let_pages_go(Database& db, std::uint64_t free) {
  if (db.integer("PRAGMA auto_vacuum") != 0) return;
  const std::int64_t bytes =
      (db.integer("PRAGMA page_count").value_or(0) - db.integer("PRAGMA freelist_count").value_or(0)) *
      db.integer("PRAGMA page_size").value_or(0);
  // The new content goes through the log.
  if (bytes > kQuicklyRewritten || free < 3 * static_cast<std::uint64_t>(bytes)) return;
  try {
    db.execute("PRAGMA auto_vacuum = INCREMENTAL; VACUUM");
    db.checkpoint();
    spdlog::info(base::logfmt("rewritten", {{"file", db.file()}, {"bytes", bytes}}));
  } catch (const SqliteError& error) {
    // No room for the temporary copy, say; everything works without.
    spdlog::warn(base::logfmt("not_rewritten", {{"file", db.file()}, {"message", error.what()}}));
  }
}

/// With the lock held: whether there is room for more than bookkeeping.
bool Store::has_room() {
  if (!disk_full_) return true;
  // A job too large for what is free must not lock all others out for ever.
  if (clock_.lease_ms() - full_disk_ms_ > kTryAgainMs) reserve_.allow_retry();
  const bool restored = reserve_.restore();
  room_wanted_ = reserve_.wanted();
  if (!restored) return false;
  db_.set_usual_log_limit();
  disk_full_ = false;
  room_again_ = true;
  return true;
}

void Store::live_on_reserve() {
  reserve_.release();
  db_.set_log_limit(kFullDiskLogBytes);
}

/// A write found the disk full: gives the reserve away, unless another one has done so meanwhile.  A client
/// that follows one of the jobs that the change was about learns why it gets no further.
void Store::make_room(const Changes& undone) {
  const std::int64_t now = clock_.lease_ms();
  bool first = false;
  {
    const base::MutexLock lock(mutex_);
    first = !disk_full_.exchange(true);
    if (first) {
      full_disk_ms_ = now;
      live_on_reserve();
      room_wanted_ = reserve_.wanted();
      try {
        db_.unclaim_pages();
      } catch (const SqliteError&) {
        // The next commit tries it again.
      }
    }
  }
  if (undone.grown || undone.refused) {
    const base::MutexLock lock(stuck_mutex_);
    stuck_.insert(undone.results.begin(), undone.results.end());
  }
  tell_full();
  if (first && listener_ != nullptr) {
    Changes stuck;
    stuck.jobs = undone.jobs;
    listener_->on_change(stuck);
  }
}

std::uint64_t Store::room_wanted(const std::string& job_id) {
  if (disk_full_) return room_wanted_;
  const base::MutexLock lock(stuck_mutex_);
  const bool stuck =
      std::any_of(stuck_.begin(), stuck_.end(), [&](const auto& task) { return task.second == job_id; });
  return stuck ? room_wanted_.load() : 0;
}

/// Of a committed change: what the full disk refused, or what was refused before and is now written, or not wanted any
/// more.
void Store::note_stuck(const Changes& made) {
  const base::MutexLock lock(stuck_mutex_);
  if (made.refused) stuck_.insert(made.results.begin(), made.results.end());
  if (made.grown && !made.partly) {
    for (const auto& [task, job] : made.results) stuck_.erase(task);
  }
  if (made.eased) std::erase_if(stuck_, [&](const auto& task) { return made.jobs.contains(task.second); });
}

/// Those on which nobody works who would try again, or that nobody wants: only what is asked for of a job that has come
/// to an end.
void Store::forget_ended_stuck() {
  std::map<std::int64_t, std::string> ended;
  {
    const base::MutexLock lock(stuck_mutex_);
    ended = stuck_;
  }
  if (ended.empty()) return;
  read([&](Database& db) {
    return std::erase_if(ended, [&](const auto& task) {
      return db
          .integer(
              "SELECT 1 FROM tasks t JOIN jobs j ON j.id = t.job_id WHERE t.id = ? AND t.state = 'leased'"
              " AND (t.on_request = 1 OR j.state IN ('queued', 'running'))",
              task.first)
          .has_value();
    });
  });
  const base::MutexLock lock(stuck_mutex_);
  for (const auto& [task, job] : ended) stuck_.erase(task);
}

void Store::tell_full() {
  const base::MutexLock lock(stuck_mutex_);
  if (!std::exchange(disk_full_told_, true)) spdlog::error(base::logfmt("disk_full", {{"file", file_}}));
}

/// Not whenever the reserve is whole again: what needs more than that is then tried once more, and mostly in vain.
void Store::tell_room() {
  {
    const base::MutexLock lock(stuck_mutex_);
    if (!disk_full_told_ || disk_full_) return;
  }
  forget_ended_stuck();
  const base::MutexLock lock(stuck_mutex_);
  if (!disk_full_told_ || disk_full_ || !stuck_.empty()) return;
  disk_full_told_ = false;
  spdlog::info(base::logfmt("disk_has_room", {{"file", file_}}));
}

/// Jobs that were stuck go on.
void Store::notify_room() {
  write([](Tx& tx) {
    settle_waiting_jobs(tx);
    return true;
  });
  if (listener_ == nullptr) return;
  Changes changes;
  changes.work = true;
  read([&](Database& db) {
    Statement row = db.query("SELECT id FROM jobs WHERE state IN ('queued', 'running')");
    while (row.step()) changes.jobs.insert(row.text(0));
    return true;
  });
  listener_->on_change(changes);
}

bool Store::tidy() {
  // Taken back first: what is dropped meanwhile must not be forgotten.
  const bool more = untidy_.exchange(false) && tidy_step();
  if (disk_full_) {
    const base::MutexLock lock(mutex_);
    has_room();
  }
  if (room_again_.exchange(false)) notify_room();
  tell_room();
  return more;
}

bool Store::tidy_step() {
  try {
    const bool more = write([](Tx& tx) { return delete_piece(tx) || give_pages_back(tx.db); });
    if (more || !shorten_log()) untidy_ = true;
    return more;
  } catch (...) {
    untidy_ = true;
    throw;
  }
}

bool Store::shorten_log() {
  const base::MutexLock lock(mutex_);
  return db_.checkpoint();
}

}  // namespace affskel::server

#pragma once

// Templates of Store, for its own source files only.

#include <spdlog/spdlog.h>

#include <chrono>

#include "base/mutex.h"
#include "metrics/metrics.h"
#include "store/store.h"

namespace affskel::server {

template <typename Body>
auto Store::commit(Body&& body, Changes& changes, bool& room) {
  const auto asked = std::chrono::steady_clock::now();
  const base::MutexLock lock(mutex_);
  const auto begun = std::chrono::steady_clock::now();
  room = room && has_room();
  Transaction transaction(db_);
  Tx tx{db_, options_, clock_.wall_ms(), clock_.lease_ms(), changes, room};
  auto value = body(tx);
  db_.claim_pages();
  transaction.commit();
  require_not_lost();
  const auto committed = std::chrono::steady_clock::now();
  changes.counts.push_back([=](Metrics& metrics) { metrics.transaction(begun - asked, committed - begun); });
  if (changes.grown || changes.eased) reserve_.allow_retry();
  return value;
}

/// Runs `body` in a transaction; on a disk that turns out to be full once more, on what the reserve gives and
/// for bookkeeping only.
template <typename Body>
auto Store::write(Body&& body) {
  Changes changes;
  auto result = [&] {
    bool room = true;
    try {
      return commit(body, changes, room);
    } catch (const SqliteError& error) {
      if (error.primary_code() != SQLITE_FULL) throw;
      make_room(changes);
      if (!room) throw;  // it had the reserve already
    }
    changes = {};
    room = false;
    return commit(body, changes, room);
  }();
  if (changes.dropped) untidy_ = true;
  for (const std::string& line : changes.log) spdlog::info(line);
  if (metrics_ != nullptr) {
    for (const auto& count : changes.counts) count(*metrics_);
  }
  if (listener_ != nullptr) listener_->on_change(changes);
  return result;
}

template <typename Body>
auto Store::read(Body&& body) {
  return readers_.read(body);
}

/// Points a job at another, finished erosion and drops its own; the job goes on in the derive stage.
void adopt_erosion(Tx& tx, const std::string& job_id, std::int64_t finished_erosion);

/// A finished erosion of this content that the owner has already, if there is one.  What others have computed
/// is computed again: a job that is done at once would tell that they have.
std::optional<std::int64_t> find_finished_erosion(Database& db, const std::string& owner,
                                                  const std::string& mesh_sha256,
                                                  const std::string& params_key,
                                                  const std::string& core_version);

/// Marks an erosion for deletion when no job needs it.
void drop_unused_erosion(Tx& tx, std::int64_t erosion_id);

}  // namespace affskel::server

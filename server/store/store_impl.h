#pragma once

// Templates of Store, for its own source files only.

#include <spdlog/spdlog.h>

#include "store/store.h"

namespace affskel::server {

template <typename Body>
auto Store::write(Body&& body) {
  Changes changes;
  auto result = [&] {
    try {
      const std::lock_guard lock(mutex_);
      Transaction transaction(db_);
      Tx tx{db_, options_, clock_.wall_ms(), clock_.lease_ms(), changes};
      const int changes_before = sqlite3_total_changes(db_.handle());
      auto value = body(tx);
      transaction.commit();
      // What changed nothing wrote nothing, and says nothing about the disk.
      if (sqlite3_total_changes(db_.handle()) != changes_before) disk_full_ = false;
      return value;
    } catch (const SqliteError& error) {
      if (error.primary_code() == SQLITE_FULL) note_full_disk(changes);
      throw;
    }
  }();
  for (const std::string& line : changes.log) spdlog::info("{}", line);
  if (listener_ != nullptr) listener_->on_change(changes);
  return result;
}

template <typename Body>
auto Store::read(Body&& body) {
  const std::lock_guard lock(mutex_);
  Transaction transaction(db_, Transaction::Kind::kRead);
  return body(db_);
}

/// Points a job at another, finished erosion and drops its own; the job goes on in the derive stage.
void adopt_erosion(Tx& tx, const std::string& job_id, std::int64_t finished_erosion);

/// A finished erosion of this content, if there is one.
std::optional<std::int64_t> find_finished_erosion(Database& db, const std::string& mesh_sha256,
                                                  const std::string& params_key,
                                                  const std::string& core_version);

/// Deletes an erosion and its mesh when no job needs them.
void drop_unused_erosion(Tx& tx, std::int64_t erosion_id);

}  // namespace affskel::server

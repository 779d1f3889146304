#include "store/store.h"

#include <filesystem>
#include <utility>

#include "database/migrate.h"
#include "errors.h"
#include "store/space.h"
#include "store/store_impl.h"
#include "store/tasks.h"

namespace affskel::server {
namespace {

std::string directory_of(const std::string& file) {
  const std::filesystem::path directory = std::filesystem::path(file).parent_path();
  return directory.empty() ? "." : directory.string();
}

}  // namespace

Store::Store(std::string file, StoreOptions options, const Clock& clock, ChangeListener* listener)
    : file_(std::move(file)),
      options_(options),
      clock_(clock),
      listener_(listener),
      reserve_(directory_of(file_), options_.reserve_bytes, options_.free_bytes),
      db_(file_, Database::Mode::kReadWrite),
      schema_version_(migrate(db_)),
      disk_full_(!reserve_.whole()) {
  if (disk_full_) live_on_reserve();
  let_pages_go(db_, options_.free_bytes(directory_of(file_)));
  write([](Tx& tx) {
    settle_finished_blocks(tx);
    return tx.db.run("UPDATE tasks SET deadline_ms = ? WHERE state = 'leased'",
                     tx.lease_ms + tx.options.lease_ms);
  });
}

v1::ReportResponse Store::reply(bool cancelled) const {
  v1::ReportResponse response;
  response.set_cancelled(cancelled);
  response.set_lease_ms(static_cast<std::uint32_t>(options_.lease_ms));
  response.set_report_interval_ms(static_cast<std::uint32_t>(options_.report_interval_ms));
  return response;
}

std::optional<std::int64_t> find_finished_erosion(Database& db, const std::string& mesh_sha256,
                                                  const std::string& params_key,
                                                  const std::string& core_version) {
  return db.integer(
      "SELECT id FROM erosions WHERE mesh_sha256 = ? AND params_key = ? AND core_version = ? AND finished = 1"
      " AND dropped = 0 ORDER BY id LIMIT 1",
      mesh_sha256, params_key, core_version);
}

void drop_unused_erosion(Tx& tx, std::int64_t erosion_id) {
  if (tx.db.integer("SELECT 1 FROM jobs WHERE erosion_id = ? LIMIT 1", erosion_id)) return;
  tx.db.run("UPDATE erosions SET dropped = 1 WHERE id = ?", erosion_id);
  tx.changes.dropped = true;
}

void adopt_erosion(Tx& tx, const std::string& job_id, std::int64_t finished_erosion) {
  const std::int64_t own = get_job(tx.db, job_id).erosion_id;
  tx.db.run("DELETE FROM tasks WHERE job_id = ?", job_id);
  tx.db.run("UPDATE jobs SET erosion_id = ?, stage = 'derive' WHERE id = ?", finished_erosion, job_id);
  if (own != finished_erosion) drop_unused_erosion(tx, own);
  tx.changes.log.push_back("event=adopted job=" + job_id + " field=" + std::to_string(finished_erosion));
  settle_job(tx, job_id);
}

}  // namespace affskel::server

#include "store/store.h"

#include <utility>

#include "store/errors.h"
#include "store/migrate.h"
#include "store/store_impl.h"
#include "store/tasks.h"

namespace affskel::server {
namespace {

// The log may be on the full disk, and workers try their reports again several times a second.
constexpr std::int64_t kTellFullDiskMs = 60000;

}  // namespace

Store::Store(std::string file, StoreOptions options, const Clock& clock, ChangeListener* listener)
    : file_(std::move(file)),
      options_(options),
      clock_(clock),
      listener_(listener),
      db_(file_, Database::Mode::kReadWrite),
      schema_version_(migrate(db_)) {
  write([](Tx& tx) {
    return tx.db.run("UPDATE tasks SET deadline_ms = ? WHERE state = 'leased'",
                     tx.lease_ms + tx.options.lease_ms);
  });
}

/// Whoever follows one of the jobs that the change was about learns why it gets no further.
void Store::note_full_disk(const Changes& undone) {
  const std::int64_t now = clock_.lease_ms();
  std::int64_t told = full_disk_told_ms_;
  if ((told == 0 || now - told >= kTellFullDiskMs) && full_disk_told_ms_.compare_exchange_strong(told, now)) {
    spdlog::error("event=disk_full file={}", file_);
  }
  if (disk_full_.exchange(true) || listener_ == nullptr) return;
  Changes stuck;
  stuck.jobs = undone.jobs;
  listener_->on_change(stuck);
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
      " ORDER BY id LIMIT 1",
      mesh_sha256, params_key, core_version);
}

void drop_unused_erosion(Tx& tx, std::int64_t erosion_id) {
  if (tx.db.integer("SELECT 1 FROM jobs WHERE erosion_id = ? LIMIT 1", erosion_id)) return;
  Statement row = tx.db.query("SELECT mesh_sha256 FROM erosions WHERE id = ?", erosion_id);
  if (!row.step()) return;
  const std::string mesh = row.text(0);
  tx.db.run("DELETE FROM erosions WHERE id = ?", erosion_id);
  tx.db.run(
      "DELETE FROM meshes WHERE sha256 = ?1 AND NOT EXISTS (SELECT 1 FROM erosions WHERE mesh_sha256 = ?1)",
      mesh);
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

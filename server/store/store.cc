#include "store/store.h"

#include <utility>

#include "base/directory.h"
#include "base/logfmt.h"
#include "database/errors.h"
#include "database/migrate.h"
#include "store/job_events.h"
#include "store/job_life.h"
#include "store/space.h"
#include "store/store_impl.h"
#include "store/task_leases.h"
#include "store/task_rows.h"
#include "store/turn.h"
#include "wire/artifact_kinds.h"
#include "wire/identity.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

void put_state(Tx& tx, const char* key, const std::string& value) {
  tx.db.run(
      "INSERT INTO server_state (key, value) VALUES (?, ?)"
      " ON CONFLICT (key) DO UPDATE SET value = excluded.value",
      key, value);
}

/// A copy of the database, put back, has forgotten what came after it.  A worker that goes on with a field from before
/// would take for known what is not.  Nothing here tells for certain whether that happened (a copy may be written into
/// the file that was there, or a whole volume set back), so that every start gives fields new names: workers fetch them
/// anew.
void rename_fields(Tx& tx) {
  put_state(tx, "database", wire::random_id());
}

/// Where it is certain, leases end, too: what their workers reported since is missing, and they would not do it again.
void recognise_file(Tx& tx, const std::string& identity) {
  Statement row = tx.db.query("SELECT value FROM server_state WHERE key = 'file'");
  const bool known = row.step();
  if (known && row.text(0) == identity) return;
  if (known) {
    release_all_leases(tx);
    tx.changes.log.push_back(base::logfmt("database_restored"));
  }
  put_state(tx, "file", identity);
}

/// What this program has beyond those that the database knows.
void add_new_kinds(Database& db) {
  for (const std::string& task : wire::words(*v1::TaskKind_descriptor())) {
    db.run("INSERT OR IGNORE INTO task_kinds (name) VALUES (?)", task);
  }
  for (const wire::ArtifactKindInfo& kind : wire::artifact_kinds()) {
    if (!kind.derived() && kind.task != v1::TASK_KIND_PREPARE) continue;  // not among the artefacts
    db.run("INSERT OR IGNORE INTO artifact_kinds (name) VALUES (?)", kind.name());
  }
}

/// Their workers could not report while no server was there: that is no pause of theirs.  The clock may have been put
/// back meanwhile, too; what lies ahead of it would never come.
void renew_all(Tx& tx) {
  for (const TaskRow& task : leased_tasks(tx.db)) {
    tx.db.run(
        "UPDATE tasks SET deadline_ms = ?1 + ?2, stalled_ms = ?1 + ?3, reported_ms = ?1, waited_ms = NULL,"
        " granted_ms = min(granted_ms, ?1) WHERE id = ?4",
        tx.lease_ms, tx.options.lease_ms, patience_ms(tx, task), task.id);
  }
}

}  // namespace

Store::Store(std::string file, StoreOptions options, const Clock& clock, ChangeListener* listener,
             Metrics* metrics)
    : file_(std::move(file)),
      options_(options),
      clock_(clock),
      listener_(listener),
      metrics_(metrics),
      reserve_(base::directory_of(file_), options_.reserve_bytes, options_.free_bytes),
      db_(ready_database_file(file_), Database::Mode::kReadWrite),
      readers_(file_),
      schema_version_(migrate(db_)),
      disk_full_(!reserve_.whole()) {
  if (disk_full_) {
    live_on_reserve();
    tell_full();
  }
  room_wanted_ = reserve_.wanted();
  let_pages_go(db_, options_.free_bytes(base::directory_of(file_)));
  write([this](Tx& tx) {
    rename_fields(tx);
    recognise_file(tx, file_identity(file_));
    add_new_kinds(tx.db);
    settle_waiting_jobs(tx);
    settle_turns(tx);
    tx.db.run("DELETE FROM tasks WHERE state = 'failed' AND on_request = 1");
    renew_all(tx);
    return true;
  });
  identity_ = OpenFile(file_);
  expect_orphans();
}

bool Store::lost() const {
  return identity_.replaced();
}

void Store::require_not_lost() const {
  if (!lost()) return;
  throw StoreError(StoreError::Code::kLost,
                   "the database " + file_ +
                       " was removed or replaced while the server ran; nothing of this"
                       " was kept");
}

/// Requests that a predecessor had: clients that wait for them ask again soon.
void Store::expect_orphans() {
  orphans_until_ms_ = clock_.lease_ms() + options_.orphan_grace_ms;
  Statement row = db_.query("SELECT id FROM tasks WHERE on_request = 1 AND state IN ('pending', 'leased')");
  while (row.step()) orphans_.insert(row.integer(0));
}

v1::ReportResponse Store::reply(bool cancelled) const {
  v1::ReportResponse response;
  response.set_cancelled(cancelled);
  response.set_lease_ms(static_cast<std::uint32_t>(options_.lease_ms));
  response.set_report_interval_ms(static_cast<std::uint32_t>(options_.report_interval_ms));
  return response;
}

std::optional<std::int64_t> find_finished_erosion(Database& db, const std::string& owner,
                                                  const std::string& mesh_sha256,
                                                  const std::string& params_key,
                                                  const std::string& core_version) {
  // One look for each erosion of the content, not at all that the owner has.
  return db.integer(
      "SELECT id FROM erosions e WHERE mesh_sha256 = ? AND params_key = ? AND core_version = ?"
      " AND finished = 1 AND dropped = 0"
      " AND EXISTS (SELECT 1 FROM owner_erosions WHERE owner = ? AND erosion_id = e.id) ORDER BY id LIMIT 1",
      mesh_sha256, params_key, core_version, owner);
}

void drop_unused_erosion(Tx& tx, std::int64_t erosion_id) {
  if (tx.db.integer("SELECT 1 FROM jobs WHERE erosion_id = ? LIMIT 1", erosion_id)) return;
  tx.db.run("UPDATE erosions SET dropped = 1 WHERE id = ?", erosion_id);
  tx.changes.dropped = true;
}

void adopt_erosion(Tx& tx, const std::string& job_id, std::int64_t finished_erosion) {
  const std::int64_t own = get_job(tx.db, job_id).erosion_id;
  tx.db.run("DELETE FROM tasks WHERE job_id = ?", job_id);
  end_stage(tx, job_id);
  tx.db.run("UPDATE jobs SET erosion_id = ?, stage = 'derive' WHERE id = ?", finished_erosion, job_id);
  if (own != finished_erosion) drop_unused_erosion(tx, own);
  add_event(tx, job_id, {.event = "adopted", .message = "another job has computed this field already"});
  settle_job(tx, job_id);
}

}  // namespace affskel::server

#include "check/repair.h"

#include <string_view>
#include <vector>

#include "check/field_faults.h"
#include "check/piece_faults.h"
#include "database/database_file.h"
#include "database/errors.h"
#include "database/migrate.h"
#include "store/blocks.h"
#include "store/clock.h"
#include "store/rows.h"
#include "store/tasks.h"
#include "store/tx.h"

namespace affskel::server {
namespace {

class Repairer {
 public:
  Repairer(const std::string& file, const RepairHandler& on_action)
      : db_(file, Database::Mode::kReadWrite), on_action_(on_action) {}

  void repair() {
    require_newest_schema();
    rebuild_indexes();
    for_each_field(db_, [&](const FieldShape& field) { repair_field(field); });
    std::vector<PieceFault> artifacts;
    find_artifact_faults(db_, [&](const PieceFault& fault) { artifacts.push_back(fault); });
    for (const PieceFault& fault : artifacts) repair_artifact(fault);
    if (repaired_) {
      write([](Tx& tx) {
        // Like a file put back from a copy: leases end, and workers fetch their fields anew (Store's
        // constructor).
        tx.db.run("UPDATE server_state SET value = 'repaired' WHERE key = 'file'");
      });
    }
  }

 private:
  template <typename Body>
  void write(Body&& body) {
    Changes changes;
    Transaction transaction(db_);
    Tx tx{db_, options_, clock_.wall_ms(), clock_.lease_ms(), changes, true};
    body(tx);
    db_.claim_pages();
    transaction.commit();
  }

  void tell(const std::string& action) {
    repaired_ = true;
    on_action_(action);
  }

  void require_newest_schema() {
    if (checked_schema(db_) == newest_schema()) return;
    throw StoreError(StoreError::Code::kUnusable,
                     db_.file() + ": of an older schema; run affskel-server migrate first");
  }

  void rebuild_indexes() {
    bool sound = true;
    {
      Statement row = db_.query("PRAGMA integrity_check(1)");
      sound = row.step() && row.text(0) == "ok";
    }
    if (sound) return;
    db_.execute("REINDEX");
    tell("the indexes were built anew");
  }

  // Fields

  void repair_field(const FieldShape& field) {
    std::vector<FieldFault> faults;
    find_field_faults(db_, field, [&](FieldFault fault) { faults.push_back(std::move(fault)); });
    if (faults.empty()) return;
    write([&](Tx& tx) {
      for (const FieldFault& fault : faults) delete_row(tx, fault);
      tx.db.run(
          "DELETE FROM field_sums WHERE erosion_id = ?1 AND NOT EXISTS (SELECT 1 FROM field_chunks"
          " WHERE erosion_id = ?1 AND idx = field_sums.idx)",
          field.erosion_id);
      restart_erosion(tx, field);
    });
    tell(faults.front().where + ": " + faults.front().what +
         (faults.size() > 1 ? ", and " + std::to_string(faults.size() - 1) + " more faults" : "") + "; all " +
         std::to_string(field.directions) + " directions are computed again");
  }

  static void delete_row(Tx& tx, const FieldFault& fault) {
    if (fault.table == nullptr) return;
    const bool chunk = std::string_view(fault.table) == "field_chunks";
    tx.db.run(chunk ? "DELETE FROM field_chunks WHERE id = ?" : "DELETE FROM field_log WHERE id = ?",
              fault.id);
  }

  /// Starts an erosion again with no direction done.  One of its jobs, an active one if there is any, goes on
  /// with what is left of the field.  The others begin anew, and take the field over when it is finished.
  /// All begin anew when no worker has the core that made it any more.
  static void restart_erosion(Tx& tx, const FieldShape& field) {
    const std::int64_t id = field.erosion_id;
    tx.db.run("DELETE FROM done_ranges WHERE erosion_id = ?", id);
    tx.db.run("UPDATE erosions SET finished = 0, directions_done = 0 WHERE id = ?", id);
    tx.db.run("DELETE FROM artifacts WHERE erosion_id = ? AND kind NOT IN ('lattice', 'directions')", id);
    bool taken = !core_is_current(tx.db, id);
    for (const std::string& job : jobs_of(tx.db, id)) {
      tx.db.run("DELETE FROM tasks WHERE job_id = ?", job);
      if (taken) {
        give_own_erosion(tx, job, id);
      } else {
        queue_again(tx, job, "erode");
        cut_blocks(tx, job, field.directions);
        taken = true;
      }
    }
    if (!tx.db.integer("SELECT 1 FROM jobs WHERE erosion_id = ? LIMIT 1", id)) {
      tx.db.run("UPDATE erosions SET dropped = 1 WHERE id = ?", id);
    }
  }

  static bool core_is_current(Database& db, std::int64_t erosion_id) {
    const std::string current = current_core_version(db);
    Statement row = db.query("SELECT core_version FROM erosions WHERE id = ?", erosion_id);
    return current.empty() || (row.step() && row.text(0) == current);
  }

  static std::vector<std::string> jobs_of(Database& db, std::int64_t erosion_id) {
    Statement row = db.query(
        "SELECT id FROM jobs WHERE erosion_id = ? ORDER BY state IN ('queued', 'running') DESC,"
        " state = 'done' DESC, seq",
        erosion_id);
    std::vector<std::string> jobs;
    while (row.step()) jobs.push_back(row.text(0));
    return jobs;
  }

  static void give_own_erosion(Tx& tx, const std::string& job, std::int64_t like) {
    tx.db.run(
        "INSERT INTO erosions (mesh_sha256, params, params_key)"
        " SELECT mesh_sha256, params, params_key FROM erosions WHERE id = ?",
        like);
    tx.db.run("UPDATE jobs SET erosion_id = ? WHERE id = ?", tx.db.last_insert_rowid(), job);
    queue_again(tx, job, "prepare");
    add_task(tx, job, v1::TASK_KIND_PREPARE);
  }

  /// Back to a stage.  What had failed for other reasons or was cancelled stays so, and can be resumed.
  static void queue_again(Tx& tx, const std::string& job, const char* stage) {
    tx.db.run(
        "UPDATE jobs SET stage = ?, skeleton_points = 0, quality = NULL,"
        " (state, finished_ms, error_code, error_message) ="
        " (SELECT iif(again, 'queued', state), iif(again, 0, finished_ms), iif(again, NULL, error_code),"
        "  iif(again, '', error_message)"
        "  FROM (SELECT state = 'done' OR ifnull(error_code, '') = 'DAMAGED' AS again))"
        " WHERE id = ?",
        stage, job);
  }

  // Artefacts

  /// Lattice and directions are made again when somebody asks for them, everything else is derived from the
  /// field again.
  void repair_artifact(const PieceFault& fault) {
    write([&](Tx& tx) {
      tx.db.run("DELETE FROM artifacts WHERE id = ?", fault.artifact);
      if (fault.name != "skeleton") return;
      for (const std::string& job : jobs_with_skeleton(tx.db, fault)) {
        tx.db.run("DELETE FROM tasks WHERE job_id = ? AND kind = 'skeleton' AND on_request = 0", job);
        queue_again(tx, job, "derive");
        settle_job(tx, job);
      }
    });
    tell(fault.where + ": " + fault.what + "; it is made again");
  }

  static std::vector<std::string> jobs_with_skeleton(Database& db, const PieceFault& fault) {
    Statement row =
        db.query("SELECT id FROM jobs WHERE erosion_id = ? AND skeleton_key = ? AND state = 'done'",
                 fault.erosion_id, fault.params_key);
    std::vector<std::string> jobs;
    while (row.step()) jobs.push_back(row.text(0));
    return jobs;
  }

  Database db_;
  const RepairHandler& on_action_;
  StoreOptions options_;
  SystemClock clock_;
  bool repaired_ = false;
};

}  // namespace

void repair_database(const std::string& data_dir, const RepairHandler& on_action) {
  Repairer(existing_database_file(data_dir), on_action).repair();
}

}  // namespace affskel::server

#include "check/repair.h"

#include <string_view>
#include <vector>

#include "check/field_faults.h"
#include "check/piece_faults.h"
#include "check/refined_faults.h"
#include "database/database_file.h"
#include "database/errors.h"
#include "database/migrate.h"
#include "store/clock.h"
#include "store/job_life.h"
#include "store/own_skeleton.h"
#include "store/restart.h"
#include "store/rows.h"
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

  void report(const std::string& action) {
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
    report("the indexes were built anew");
  }

  // Fields

  void repair_field(const FieldShape& field) {
    std::vector<FieldFault> faults;
    find_field_faults(db_, field, [&](FieldFault fault) { faults.push_back(std::move(fault)); });
    if (faults.empty()) return repair_refinement(field);
    write([&](Tx& tx) {
      for (const FieldFault& fault : faults) delete_row(tx, fault);
      tx.db.run(
          "DELETE FROM field_sums WHERE erosion_id = ?1 AND NOT EXISTS (SELECT 1 FROM field_chunks"
          " WHERE erosion_id = ?1 AND idx = field_sums.idx)",
          field.erosion_id);
      tx.db.run("DELETE FROM done_ranges WHERE erosion_id = ?", field.erosion_id);
      restart_erosion(tx, field.erosion_id, field.directions);
    });
    report(faults.front().where + ": " + faults.front().what +
           (faults.size() > 1 ? ", and " + std::to_string(faults.size() - 1) + " more faults" : "") +
           "; all " + std::to_string(field.directions) + " directions are computed again");
  }

  void repair_refinement(const FieldShape& field) {
    std::vector<FieldFault> faults;
    find_refined_faults(db_, field, [&](FieldFault fault) { faults.push_back(std::move(fault)); });
    if (faults.empty()) return;
    write([&](Tx& tx) { restart_erosion(tx, field.erosion_id, field.directions); });
    report(faults.front().where + ": " + faults.front().what + "; the refinement begins anew");
  }

  static void delete_row(Tx& tx, const FieldFault& fault) {
    if (fault.table == nullptr) return;
    const bool chunk = std::string_view(fault.table) == "field_chunks";
    tx.db.run(chunk ? "DELETE FROM field_chunks WHERE id = ?" : "DELETE FROM field_log WHERE id = ?",
              fault.id);
  }

  // Artefacts

  /// Lattice and directions are made again when a client asks for them, everything else is derived from the
  /// field again.
  void repair_artifact(const PieceFault& fault) {
    write([&](Tx& tx) {
      tx.db.run("DELETE FROM artifacts WHERE id = ?", fault.artifact);
      for (const std::string& job : jobs_with_skeleton(tx.db, fault)) {
        tx.db.run("DELETE FROM tasks WHERE job_id = ? AND kind = ? AND on_request = 0", job, fault.name);
        queue_again(tx, job, "derive");
        settle_job(tx, job);
      }
    });
    report(fault.where + ": " + fault.what + "; it is made again");
  }

  static std::vector<std::string> jobs_with_skeleton(Database& db, const PieceFault& fault) {
    Statement row = db.query("SELECT id FROM jobs WHERE erosion_id = ? AND state = 'done'", fault.erosion_id);
    std::vector<std::string> jobs;
    while (row.step()) {
      const auto& [kind, params] = own_skeleton(get_job(db, row.text(0)));
      if (kind.name() == fault.name && params.key == fault.params_key) jobs.push_back(row.text(0));
    }
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

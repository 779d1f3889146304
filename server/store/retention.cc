#include "store/retention.h"

#include <algorithm>

#include "store/job_events.h"
#include "store/quota.h"
#include "store/store_impl.h"
#include "store/task_rows.h"

namespace affskel::server {
namespace {

/// Nothing but the mesh is there: results were removed, or it ended before it was prepared.
bool is_bare(const JobRow& job) {
  return job.removed_ms > 0 || job.core_version.empty();
}

// While a call waits for an artefact of a job.
constexpr std::int64_t kPostponedMs = 60'000;

/// Age since a job's end after which its results, or the job itself, go; 0 = never.  Results never outlive
/// the age at which the job would go.
std::int64_t age_of(const Retention& retention, bool bare) {
  if (bare || retention.results_age_ms == 0) return retention.jobs_age_ms;
  return retention.results_age_ms;
}

const char* age_rule(const Retention& retention, bool bare) {
  return bare || retention.results_age_ms == 0 ? "jobs-age" : "results-age";
}

bool asked_for(Database& db, const std::string& job) {
  return db
      .integer(
          "SELECT 1 FROM tasks WHERE job_id = ? AND state IN ('pending', 'leased') AND on_request = 1"
          " LIMIT 1",
          job)
      .has_value();
}

std::vector<std::string> all_owners(Database& db) {
  std::vector<std::string> owners;
  Statement row = db.query("SELECT owner FROM owner_use");
  while (row.step()) owners.push_back(row.text(0));
  return owners;
}

class Planner {
 public:
  Planner(Database& db, const Policy& policy, std::int64_t now_ms, std::size_t most)
      : db_(db), policy_(policy), now_ms_(now_ms), most_(most) {}

  std::vector<Removal> plan() {
    for (const std::string& owner : all_owners(db_)) {
      const Retention& retention = policy_.of(owner).retention;
      for (const Jobs jobs : kInOrder) by_age(owner, retention, jobs);
      if (retention.stored_bytes > 0) {
        by_bytes({owner}, use_of(db_, owner).stored_bytes - retention.stored_bytes, "stored-bytes");
      }
    }
    if (policy_.total_bytes > 0) {
      by_bytes(all_owners(db_), use_of_all(db_).stored_bytes - policy_.total_bytes, "total-bytes");
    }
    return std::move(found_);
  }

 private:
  /// Whose results were removed, and which never had any; apart, as the index has them.
  struct Jobs {
    bool removed, bare;
  };
  static constexpr Jobs kInOrder[] = {{false, false}, {false, true}, {true, true}};

  bool full() const { return found_.size() >= most_; }

  bool is_found(const std::string& job) const {
    return std::any_of(found_.begin(), found_.end(),
                       [&](const Removal& removal) { return removal.job == job; });
  }

  void by_age(const std::string& owner, const Retention& retention, Jobs jobs) {
    const std::int64_t age = age_of(retention, jobs.bare);
    if (age == 0) return;
    Statement row = db_.query(
        "SELECT j.id, j.finished_ms FROM jobs j CROSS JOIN erosions e ON e.id = j.erosion_id"
        " WHERE j.owner = ?1 AND (j.removed_ms > 0) = ?2"
        " AND (?2 OR (e.core_version IS NULL) = ?3) AND j.pinned = 0"
        " AND j.expires_ms = 0 AND j.finished_ms > 0 AND j.finished_ms <= ?4 ORDER BY j.finished_ms",
        owner, jobs.removed, jobs.bare, now_ms_ + policy_.grace_ms - age);
    while (!full() && row.step()) {
      found_.push_back({row.text(0), std::max(row.integer(1) + age, now_ms_ + policy_.grace_ms), jobs.bare,
                        age_rule(retention, jobs.bare)});
    }
  }

  /// What planned removals will free counts as free already.
  std::int64_t planned_bytes(const std::string& owner) {
    return db_
        .integer(
            "SELECT sum(iif(j.removed_ms > 0 OR e.core_version IS NULL, m.bytes, e.bytes)) FROM jobs j"
            " JOIN erosions e ON e.id = j.erosion_id"
            " JOIN meshes m ON m.sha256 = e.mesh_sha256 WHERE j.expires_ms > 0 AND j.owner = ?",
            owner)
        .value_or(0);
  }

  struct Old {
    std::string job;
    std::int64_t finished_ms = 0;
    std::int64_t bytes = 0;
  };

  std::vector<Old> oldest(const std::vector<std::string>& owners, bool bare) {
    std::vector<Old> found;
    for (const std::string& owner : owners) {
      for (const Jobs jobs : kInOrder) {
        if (jobs.bare != bare) continue;
        Statement row = db_.query(
            "SELECT j.id, j.finished_ms, iif(?3, m.bytes, e.bytes) FROM jobs j"
            " CROSS JOIN erosions e ON e.id = j.erosion_id"
            " CROSS JOIN meshes m ON m.sha256 = e.mesh_sha256 WHERE j.owner = ?1 AND (j.removed_ms > 0) = ?2"
            " AND (?2 OR (e.core_version IS NULL) = ?3) AND j.pinned = 0 AND j.expires_ms = 0"
            " AND j.finished_ms > 0 ORDER BY j.finished_ms LIMIT ?4",
            owner, jobs.removed, bare, most_);
        while (row.step()) found.push_back({row.text(0), row.integer(1), row.integer(2)});
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Old& a, const Old& b) { return a.finished_ms < b.finished_ms; });
    return found;
  }

  void by_bytes(const std::vector<std::string>& owners, std::int64_t excess, const char* rule) {
    if (excess <= 0) return;
    for (const std::string& owner : owners) excess -= planned_bytes(owner);
    for (const bool bare : {false, true}) {
      for (const Old& old : oldest(owners, bare)) {
        if (excess <= 0 || full()) return;
        if (is_found(old.job)) continue;
        found_.push_back({old.job, now_ms_ + policy_.grace_ms, bare, rule});
        excess -= old.bytes;
      }
    }
  }

  Database& db_;
  const Policy& policy_;
  const std::int64_t now_ms_;
  const std::size_t most_;
  std::vector<Removal> found_;
};

/// What there is reason to remove a job for now.
const char* rule_for(Tx& tx, const JobRow& job) {
  const Policy& policy = tx.options.policy;
  const Retention& retention = policy.of(job.owner).retention;
  const bool bare = is_bare(job);
  const std::int64_t age = age_of(retention, bare);
  if (age > 0 && job.finished_ms + age <= tx.wall_ms) return age_rule(retention, bare);
  if (retention.stored_bytes > 0 && use_of(tx.db, job.owner).stored_bytes > retention.stored_bytes) {
    return "stored-bytes";
  }
  if (policy.total_bytes > 0 && use_of_all(tx.db).stored_bytes > policy.total_bytes) return "total-bytes";
  return nullptr;
}

void remove_results(Tx& tx, const JobRow& job) {
  tx.db.run("DELETE FROM tasks WHERE job_id = ?", job.id);
  if (job.state == v1::JOB_STATE_DONE) {
    // What the mesh is like stays known.
    const std::int64_t old = job.erosion_id;
    tx.db.run(
        "INSERT INTO erosions (mesh_sha256, params, params_key, core_version, prepared, points, directions,"
        " stride)"
        " SELECT mesh_sha256, params, params_key, core_version, prepared, points, directions, stride"
        " FROM erosions WHERE id = ?",
        old);
    tx.db.run("UPDATE jobs SET erosion_id = ? WHERE id = ?", tx.db.last_insert_rowid(), job.id);
    drop_unused_erosion(tx, old);
  } else {
    begin_erosion_anew(tx, job);
    tx.db.run("UPDATE jobs SET stage = 'prepare' WHERE id = ?", job.id);
    add_task(tx, job.id, v1::TASK_KIND_PREPARE);
  }
  tx.db.run("UPDATE jobs SET removed_ms = ?, expires_ms = 0 WHERE id = ?", tx.wall_ms, job.id);
}

/// "the results, by results-age".
std::string removed_text(bool with_mesh, const std::string& rule) {
  return (with_mesh ? "the job with its mesh, by " : "the results, by ") + rule;
}

}  // namespace

std::vector<Removal> removals_to_plan(Database& db, const Policy& policy, std::int64_t now_ms,
                                      std::size_t most) {
  return Planner(db, policy, now_ms, most).plan();
}

void plan_removals(Tx& tx, const std::vector<Removal>& removals) {
  for (const Removal& removal : removals) {
    const std::int64_t changed = tx.db.run(
        "UPDATE jobs SET expires_ms = ?2 WHERE id = ?1 AND expires_ms = 0 AND pinned = 0 AND finished_ms > 0"
        " AND (removed_ms > 0 OR (SELECT core_version FROM erosions WHERE id = erosion_id) IS NULL) = ?3",
        removal.job, removal.at_ms, removal.with_mesh);
    if (changed == 0) continue;
    tx.changes.jobs.insert(removal.job);
    add_event(tx, removal.job,
              {.event = "removal_planned",
               .message = removed_text(removal.with_mesh, removal.rule) + ", in " +
                          std::to_string((removal.at_ms - tx.wall_ms) / 1000) + " s"});
  }
}

std::vector<std::string> removals_due(Database& db, std::int64_t now_ms, std::size_t most) {
  Statement row =
      db.query("SELECT id FROM jobs WHERE expires_ms > 0 AND expires_ms <= ? ORDER BY expires_ms LIMIT ?",
               now_ms, most);
  std::vector<std::string> due;
  while (row.step()) due.push_back(row.text(0));
  return due;
}

void carry_out_removal(Tx& tx, const std::string& job_id) {
  const JobRow job = get_job(tx.db, job_id);
  const char* rule = job.pinned || job.active() ? nullptr : rule_for(tx, job);
  if (rule == nullptr || asked_for(tx.db, job_id)) {
    tx.db.run("UPDATE jobs SET expires_ms = ? WHERE id = ?", rule == nullptr ? 0 : tx.wall_ms + kPostponedMs,
              job_id);
    tx.changes.jobs.insert(job_id);
    return;
  }
  add_event(tx, job_id, {.event = "removed", .message = removed_text(is_bare(job), rule)});
  if (is_bare(job)) return delete_job(tx, job);
  remove_results(tx, job);
  tx.changes.jobs.insert(job_id);
}

void begin_erosion_anew(Tx& tx, const JobRow& job) {
  tx.db.run(
      "INSERT INTO erosions (mesh_sha256, params, params_key)"
      " SELECT mesh_sha256, params, params_key FROM erosions WHERE id = ?",
      job.erosion_id);
  tx.db.run("UPDATE jobs SET erosion_id = ? WHERE id = ?", tx.db.last_insert_rowid(), job.id);
  drop_unused_erosion(tx, job.erosion_id);
}

void delete_job(Tx& tx, const JobRow& job) {
  tx.db.run("DELETE FROM jobs WHERE id = ?", job.id);
  drop_unused_erosion(tx, job.erosion_id);
  tx.changes.dropped = true;  // a source that no other job has, too
  tx.changes.eased = true;
  tx.changes.jobs.insert(job.id);
}

}  // namespace affskel::server

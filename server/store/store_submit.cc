#include "base/number_text.h"
#include "base/quoted.h"
#include "database/errors.h"
#include "store/job_events.h"
#include "store/quota.h"
#include "store/store_impl.h"
#include "store/submission.h"
#include "store/task_rows.h"
#include "wire/identity.h"

namespace affskel::server {
namespace {

/// Job of an earlier submission with the same request id; "" when there is none.
std::string find_request(Database& db, const Submission& submission) {
  const std::string& request_id = submission.header.request_id();
  if (request_id.empty()) return {};
  Statement row = db.query(
      "SELECT r.job_id, e.mesh_sha256 = ?2 AND e.params_key = ?3 AND j.skeleton_key = ?4 AND j.name = ?5"
      " AND ifnull((SELECT source_sha256 FROM repairs WHERE job_id = j.id), '') = ?7"
      " FROM requests r JOIN jobs j ON j.id = r.job_id JOIN erosions e ON e.id = j.erosion_id"
      " WHERE r.owner = ?6 AND r.request_id = ?1",
      request_id, submission.header.mesh_sha256(), submission.params_key, submission.skeleton_key,
      submission.header.name(), submission.header.owner(), submission.header.repair().source_sha256());
  if (!row.step()) return {};
  if (!row.flag(1)) {
    throw StoreError(StoreError::Code::kExists, "the request id " + base::quoted(request_id) +
                                                    " was used before for another submission (job " +
                                                    row.text(0) + ")");
  }
  return row.text(0);
}

/// As in jobs.content.
std::string content_of(const Submission& submission) {
  const std::string& source = submission.header.repair().source_sha256();
  return submission.header.mesh_sha256() + " " + submission.params_key + (source.empty() ? "" : " " + source);
}

/// Job that does or did exactly this for the same owner under the same name; "" when there is none.
std::string find_equal_job(Database& db, const Submission& submission) {
  Statement row = db.query(
      "SELECT j.id FROM jobs j INDEXED BY jobs_by_content CROSS JOIN erosions e ON e.id = j.erosion_id"
      " WHERE j.owner = ? AND j.name = ? AND j.content = ? AND j.skeleton_key = ?"
      " AND (e.core_version IS NULL OR e.core_version = ?)"
      " AND j.state IN ('queued', 'running', 'done') AND j.cancel_requested = 0 AND j.removed_ms = 0"
      " ORDER BY j.seq DESC LIMIT 1",
      submission.header.owner(), submission.header.name(), content_of(submission), submission.skeleton_key,
      current_core_version(db));
  return row.step() ? row.text(0) : std::string();
}

// Each is kept as long as the job.
constexpr std::int64_t kMaxRequestIds = 1000;

void remember_request(Tx& tx, const Submission& submission, const std::string& job_id) {
  if (submission.header.request_id().empty()) return;
  const std::int64_t known =
      tx.db
          .integer(
              "SELECT count(*) FROM (SELECT 1 FROM requests WHERE job_id = ? AND request_id <> ? LIMIT ?)",
              job_id, submission.header.request_id(), kMaxRequestIds)
          .value_or(0);
  if (known == kMaxRequestIds) {
    throw StoreError(StoreError::Code::kLimit,
                     "job " + job_id + " answers " + std::to_string(known) +
                         " request ids, and no more are kept; submit it with one of these, or without");
  }
  tx.db.run("INSERT INTO requests (owner, request_id, job_id) VALUES (?, ?, ?) ON CONFLICT DO NOTHING",
            submission.header.owner(), submission.header.request_id(), job_id);
}

/// "@last" of the owner, and of all, is this job until another is submitted.
void remember_repeated(Tx& tx, const std::string& owner, const std::string& job_id) {
  for (const std::string& whose : {owner, std::string()}) {
    tx.db.run(
        "INSERT INTO server_state (key, value) VALUES ('repeated_job/' || ?, ?)"
        " ON CONFLICT (key) DO UPDATE SET value = excluded.value",
        whose, job_id);
  }
}

void keep_source(Tx& tx, const Submission& submission, const std::string& job_id, std::string_view source) {
  const v1::SubmitJobHeader& header = submission.header;
  if (!header.has_repair()) return;
  put_mesh(tx, header.repair().source_sha256(), source);
  const std::string report = header.repair().SerializeAsString();
  tx.db.run("INSERT INTO repairs (job_id, owner, source_sha256, report) VALUES (?, ?, ?, ?)", job_id,
            header.owner(), header.repair().source_sha256(), Blob{report});
}

std::string insert_job(Tx& tx, const Submission& submission, const GivenMeshes& meshes) {
  const v1::SubmitJobHeader& header = submission.header;
  put_mesh(tx, header.mesh_sha256(), meshes.mesh);
  const std::string params = submission.params.SerializeAsString();
  const std::string skeleton = submission.skeleton.SerializeAsString();
  tx.db.run("INSERT INTO erosions (mesh_sha256, params, params_key) VALUES (?, ?, ?)", header.mesh_sha256(),
            Blob{params}, submission.params_key);
  std::string id = wire::random_id();
  tx.db.run(
      "INSERT INTO jobs"
      " (id, name, owner, priority, state, stage, erosion_id, skeleton, skeleton_key, created_ms, queued_ms,"
      " content)"
      " VALUES (?1, ?2, ?3, ?4, 'queued', 'prepare', ?5, ?6, ?7, ?8, ?8, ?9)",
      id, header.name(), header.owner(), header.priority(), tx.db.last_insert_rowid(), Blob{skeleton},
      submission.skeleton_key, tx.wall_ms, content_of(submission));
  keep_source(tx, submission, id, meshes.source);
  tx.db.run("DELETE FROM server_state WHERE key IN ('repeated_job/', 'repeated_job/' || ?)", header.owner());
  tx.changes.jobs.insert(id);
  add_event(tx, id,
            {.event = "submitted",
             .message = "mesh of " + base::counted(meshes.mesh.size(), "byte") + ", SHA-256 " +
                        header.mesh_sha256()});
  tx.changes.counts.push_back([](Metrics& metrics) { metrics.job_submitted(); });
  return id;
}

}  // namespace

Store::Submitted Store::submit(const v1::SubmitJobHeader& header, std::string_view bytes) {
  return submit(check(header), bytes);
}

Submission Store::check(const v1::SubmitJobHeader& header) {
  Submission submission = checked_submission(header, options_.max_mesh_bytes);
  // Before the mesh is sent; the transaction that stores it looks again.
  read([&](Database& db) {
    if (!find_request(db, submission).empty() || !find_equal_job(db, submission).empty()) return false;
    require_quota(db, options_.policy, submission);
    return true;
  });
  return submission;
}

Store::Submitted Store::submit(const Submission& submission, std::string_view bytes) {
  const GivenMeshes meshes = checked_meshes(submission, bytes);
  require_not_lost();
  const v1::SubmitJobHeader& header = submission.header;
  const auto damaged = [&](const std::string& sha256, std::string_view mesh) {
    const bool stored = read([&](Database& db) {
      return db.integer("SELECT 1 FROM meshes WHERE sha256 = ?", sha256).has_value();
    });
    return stored && mesh_is_damaged(file_, sha256, mesh);
  };
  const bool heals = damaged(header.mesh_sha256(), meshes.mesh);
  const bool heals_source = header.has_repair() && damaged(header.repair().source_sha256(), meshes.source);
  return write([&](Tx& tx) -> Submitted {
    if (heals) heal_mesh(tx, header.mesh_sha256(), meshes.mesh);
    if (heals_source) heal_mesh(tx, header.repair().source_sha256(), meshes.source);
    std::string earlier = find_request(tx.db, submission);
    if (earlier.empty()) earlier = find_equal_job(tx.db, submission);
    if (!earlier.empty()) {
      // The same work, submitted again: done once, with the higher of the two priorities.
      if (tx.db.run("UPDATE jobs SET priority = ?2 WHERE id = ?1 AND priority < ?2 AND state <> 'done'",
                    earlier, header.priority()) > 0) {
        tx.changes.jobs.insert(earlier);
      }
      remember_request(tx, submission, earlier);
      remember_repeated(tx, header.owner(), earlier);
      add_event(tx, earlier, {.event = "submitted_again"});
      return {job_message(tx.db, earlier), true};
    }
    require_quota(tx.db, options_.policy, submission);
    tx.require_room();
    const std::string id = insert_job(tx, submission, meshes);
    remember_request(tx, submission, id);
    const std::optional<std::int64_t> finished = find_finished_erosion(
        tx.db, header.owner(), header.mesh_sha256(), submission.params_key, current_core_version(tx.db));
    if (finished) {
      adopt_erosion(tx, id, *finished);
    } else {
      add_task(tx, id, v1::TASK_KIND_PREPARE);
    }
    return {job_message(tx.db, id), false};
  });
}

}  // namespace affskel::server

#include <stdexcept>

#include "store/errors.h"
#include "store/store_impl.h"
#include "store/tasks.h"
#include "wire/identity.h"
#include "wire/params.h"
#include "wire/sha256.h"

namespace affskel::server {
namespace {

constexpr std::size_t kMaxNameBytes = 200;
constexpr std::size_t kMaxOwnerBytes = 100;
constexpr std::size_t kMaxRequestIdBytes = 200;
constexpr std::size_t kMaxDirectionsBytes = 1000;  // kept and sent with every job
constexpr std::uint32_t kMaxPriority = 9;

[[noreturn]] void refuse(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, why);
}

/// A checked submission in canonical form.
struct Submission {
  const v1::SubmitJobHeader& header;
  std::string_view mesh;
  v1::ErosionParams params;
  v1::SkeletonParams skeleton;
  std::string params_key;
  std::string skeleton_key;
  std::string content_key;
};

void check_header(const v1::SubmitJobHeader& header, std::string_view mesh) {
  if (header.name().size() > kMaxNameBytes) refuse("the name has more than 200 bytes");
  if (header.owner().size() > kMaxOwnerBytes) refuse("the owner has more than 100 bytes");
  if (header.request_id().size() > kMaxRequestIdBytes) refuse("the request id has more than 200 bytes");
  if (header.params().directions().size() > kMaxDirectionsBytes) {
    refuse("the direction set has more than 1000 bytes");
  }
  if (header.priority() > kMaxPriority) refuse("the priority must be 0 .. 9");
  if (mesh.empty()) refuse("the mesh file is empty");
  if (header.mesh_bytes() != mesh.size()) {
    refuse("the mesh was announced with " + std::to_string(header.mesh_bytes()) + " bytes, but " +
           std::to_string(mesh.size()) + " arrived");
  }
  if (wire::sha256_hex(mesh) != header.mesh_sha256()) {
    refuse("the mesh that arrived does not have the announced SHA-256");
  }
}

Submission check(const v1::SubmitJobHeader& header, std::string_view mesh) {
  check_header(header, mesh);
  Submission submission{header, mesh, {}, {}, {}, {}, {}};
  try {
    submission.params = wire::canonical(header.params());
    submission.skeleton = wire::canonical(header.skeleton());
  } catch (const std::invalid_argument& error) {
    refuse(error.what());
  }
  submission.params_key = wire::cache_key(submission.params);
  submission.skeleton_key = wire::cache_key(submission.skeleton);
  // Lengths first, so that no two contents have the same text.
  wire::Sha256 hash;
  for (const std::string& part : {header.mesh_sha256(), submission.params_key, submission.skeleton_key,
                                  header.name(), header.owner(), std::to_string(header.priority())}) {
    hash.update(std::to_string(part.size()) + ":");
    hash.update(part);
  }
  submission.content_key = hash.hex_digest();
  return submission;
}

/// Job of an earlier submission with the same request id; "" when there is none.
std::string find_request(Database& db, const Submission& submission) {
  const std::string& request_id = submission.header.request_id();
  if (request_id.empty()) return {};
  Statement row = db.query("SELECT content_key, job_id FROM requests WHERE request_id = ?", request_id);
  if (!row.step()) return {};
  if (row.text(0) != submission.content_key) {
    throw StoreError(StoreError::Code::kExists, "the request id '" + request_id +
                                                    "' was used before for another submission (job " +
                                                    row.text(1) + ")");
  }
  return row.text(1);
}

/// Job that does or did exactly this for the same owner under the same name; "" when there is none.
std::string find_equal_job(Database& db, const Submission& submission) {
  Statement row = db.query(
      "SELECT j.id FROM jobs j JOIN erosions e ON e.id = j.erosion_id"
      " WHERE e.mesh_sha256 = ? AND e.params_key = ? AND (e.core_version IS NULL OR e.core_version = ?)"
      " AND j.owner = ? AND j.name = ? AND j.skeleton_key = ?"
      " AND j.state IN ('queued', 'running', 'done') AND j.cancel_requested = 0 ORDER BY j.seq DESC LIMIT 1",
      submission.header.mesh_sha256(), submission.params_key, current_core_version(db),
      submission.header.owner(), submission.header.name(), submission.skeleton_key);
  return row.step() ? row.text(0) : std::string();
}

void remember_request(Tx& tx, const Submission& submission, const std::string& job_id) {
  if (submission.header.request_id().empty()) return;
  tx.db.run("INSERT INTO requests (request_id, content_key, job_id) VALUES (?, ?, ?) ON CONFLICT DO NOTHING",
            submission.header.request_id(), submission.content_key, job_id);
}

std::string insert_job(Tx& tx, const Submission& submission) {
  const v1::SubmitJobHeader& header = submission.header;
  put_mesh(tx, header.mesh_sha256(), submission.mesh);
  const std::string params = submission.params.SerializeAsString();
  const std::string skeleton = submission.skeleton.SerializeAsString();
  tx.db.run("INSERT INTO erosions (mesh_sha256, params, params_key) VALUES (?, ?, ?)", header.mesh_sha256(),
            Blob{params}, submission.params_key);
  std::string id = wire::random_id();
  tx.db.run(
      "INSERT INTO jobs"
      " (id, name, owner, priority, state, stage, erosion_id, skeleton, skeleton_key, created_ms)"
      " VALUES (?, ?, ?, ?, 'queued', 'prepare', ?, ?, ?, ?)",
      id, header.name(), header.owner(), header.priority(), tx.db.last_insert_rowid(), Blob{skeleton},
      submission.skeleton_key, tx.wall_ms);
  tx.changes.jobs.insert(id);
  tx.changes.log.push_back("event=submitted job=" + id + " mesh=" + header.mesh_sha256() +
                           " bytes=" + std::to_string(submission.mesh.size()) + " " + submission.params_key);
  return id;
}

}  // namespace

Store::Submitted Store::submit(const v1::SubmitJobHeader& header, std::string_view mesh) {
  if (mesh.size() > options_.max_mesh_bytes) {
    throw StoreError(StoreError::Code::kLimit, "the mesh has " + std::to_string(mesh.size()) +
                                                   " bytes; the limit is " +
                                                   std::to_string(options_.max_mesh_bytes));
  }
  const Submission submission = check(header, mesh);
  return write([&](Tx& tx) -> Submitted {
    if (const std::string id = find_request(tx.db, submission); !id.empty())
      return {job_message(tx.db, id), true};
    if (const std::string id = find_equal_job(tx.db, submission); !id.empty()) {
      // The same work twice: done once, and as urgent as the more urgent of the two.
      if (tx.db.run("UPDATE jobs SET priority = ?2 WHERE id = ?1 AND priority < ?2 AND state <> 'done'", id,
                    header.priority()) > 0) {
        tx.changes.jobs.insert(id);
      }
      remember_request(tx, submission, id);
      return {job_message(tx.db, id), true};
    }
    tx.require_room();
    const std::string id = insert_job(tx, submission);
    remember_request(tx, submission, id);
    const std::optional<std::int64_t> finished = find_finished_erosion(
        tx.db, header.mesh_sha256(), submission.params_key, current_core_version(tx.db));
    if (finished) {
      adopt_erosion(tx, id, *finished);
    } else {
      add_task(tx, id, v1::TASK_KIND_PREPARE);
    }
    return {job_message(tx.db, id), false};
  });
}

}  // namespace affskel::server

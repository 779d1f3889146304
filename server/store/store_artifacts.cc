#include <spdlog/spdlog.h>

#include <functional>
#include <stdexcept>
#include <utility>

#include "base/logfmt.h"
#include "database/errors.h"
#include "store/job_events.h"
#include "store/job_life.h"
#include "store/quota.h"
#include "store/store_impl.h"
#include "store/task_rows.h"
#include "wire/artifact_kinds.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

/// What wire says of a wrong request is the caller's mistake.
template <typename Body>
auto as_request_error(Body&& body) {
  try {
    return body();
  } catch (const std::invalid_argument& error) {
    throw StoreError(StoreError::Code::kInvalid, error.what());
  }
}

/// A derived artefact: what to look for, and the task that would make it.
struct Derived {
  ArtifactKey key;
  v1::TaskKind task;
  std::string params;
};

Derived derived_artifact(const JobRow& job, const wire::ArtifactKindInfo& kind,
                         const v1::FetchArtifactRequest& request) {
  v1::SkeletonParams skeleton;
  skeleton.ParseFromString(job.skeleton);
  const wire::CanonicalParams params =
      as_request_error([&] { return wire::artifact_params(kind, request, skeleton); });
  return {{job.erosion_id, kind.name(), params.key}, kind.task, params.bytes};
}

std::string progress_of(const JobRow& job) {
  const std::string done = progress_text(job);
  return wire::word(job.state) + ", stage " + wire::word(job.stage) + (done.empty() ? "" : ", " + done);
}

/// Why the job has no such thing, and whether waiting helps.
StoreError missing(Database& db, const JobRow& job, const std::string& what) {
  std::string why = "job " + job.id + " has no " + what;
  if (job.active()) {
    why += " yet (" + progress_of(job) + ")";
  } else {
    why += " (" + progress_of(job) + ")";
    Statement error = db.query("SELECT error_code, error_message FROM jobs WHERE id = ?", job.id);
    if (job.state == v1::JOB_STATE_FAILED && error.step()) {
      why += ": " + error.text(0) + ": " + error.text(1);
    }
    if (job.state == v1::JOB_STATE_CANCELLED) why += ": resume it";
  }
  return {StoreError::Code::kPrecondition, why};
}

std::int64_t stored_artifact(Database& db, const JobRow& job, const std::string& kind) {
  const std::optional<std::int64_t> id = find_artifact(db, {job.erosion_id, kind, ""});
  if (!id) throw missing(db, job, kind);
  return *id;
}

// The mesh that the job's came of by a repair.
std::string source_of(Database& db, const JobRow& job) {
  Statement row = db.query("SELECT source_sha256 FROM repairs WHERE job_id = ?", job.id);
  if (row.step()) return row.text(0);
  throw StoreError(StoreError::Code::kNotFound,
                   "the mesh of job " + job.id + " was not repaired: it is as it was given");
}

void require_results(const JobRow& job) {
  if (job.removed_ms == 0) return;
  throw StoreError(
      StoreError::Code::kPrecondition,
      "the results of job " + job.id +
          " were removed by retention, its mesh is kept: resume the job, which computes them again;"
          " pin it to keep them then");
}

void require_refines(const JobRow& job) {
  if (job.refines) return;
  throw StoreError(StoreError::Code::kPrecondition,
                   "job " + job.id + " has no refined field: its E is the minimum over a set of directions");
}

void require_finished(Database& db, const JobRow& job) {
  if (!job.finished) throw missing(db, job, "complete field");
}

/// The task that will bring the artefact: one that is queued already, or a new one.
std::int64_t request_derived(Tx& tx, const JobRow& job, const Derived& wanted) {
  if (const std::optional<std::int64_t> task = tx.db.integer(
          "SELECT id FROM tasks WHERE job_id = ? AND kind = ? AND params_key = ?"
          " AND state IN ('pending', 'leased') AND (on_request = 1 OR ?) LIMIT 1",
          job.id, wanted.key.kind, wanted.key.params_key, job.active() && !job.cancel_requested)) {
    return *task;
  }
  require_stored_room(tx.db, tx.options.policy, job.owner, 0);
  tx.require_room();
  const std::int64_t task =
      add_derive_task(tx, job.id, wanted.task, wanted.params, wanted.key.params_key, true);
  add_event(tx, job.id, {.event = "requested", .task = task, .kind = wanted.task});
  return task;
}

/// The same for lattice and directions, which are there unless check --repair had to delete them.
std::int64_t request_prepared(Tx& tx, const JobRow& job) {
  if (const std::optional<std::int64_t> task = tx.db.integer(
          "SELECT id FROM tasks WHERE job_id = ? AND kind = 'prepare' AND state IN ('pending', 'leased')"
          " AND on_request = 1 LIMIT 1",
          job.id)) {
    return *task;
  }
  tx.require_room();
  const std::int64_t task = add_prepare_request(tx, job.id);
  add_event(tx, job.id, {.event = "requested", .task = task, .kind = v1::TASK_KIND_PREPARE});
  return task;
}

/// Error of a task that failed; nothing while it may still succeed or when it has.
std::optional<v1::JobError> task_error(Database& db, std::int64_t task) {
  Statement row = db.query(
      "SELECT t.state, t.error_code, t.error_message, t.on_request, j.state, j.error_code, j.error_message"
      " FROM tasks t JOIN jobs j ON j.id = t.job_id WHERE t.id = ?",
      task);
  if (!row.step()) throw StoreError(StoreError::Code::kPrecondition, "the request was cancelled");
  Columns columns(row);
  const bool failed = columns.text() == "failed";
  v1::JobError error;
  error.set_code(columns.text());
  error.set_message(columns.text());
  if (failed) return error;
  // The job's own skeleton comes with the job, or fails with it.
  const bool on_request = columns.flag(), job_failed = columns.text() == "failed";
  if (on_request || !job_failed) return std::nullopt;
  error.set_code(columns.text());
  error.set_message(columns.text());
  return error;
}

}  // namespace

Store::ArtifactState Store::open_artifact(const v1::FetchArtifactRequest& request, std::int64_t asked) {
  std::string mesh;
  std::int64_t field = 0, refined = 0;
  std::int64_t artifact = 0;
  as_request_error([&] { wire::check_request(request); });
  const wire::ArtifactKindInfo& kind = *wire::find_artifact_kind(request.kind());
  ArtifactState state;
  state.task = write([&](Tx& tx) -> std::int64_t {
    mutex_.assert_held();
    const JobRow job = get_job(tx.db, resolve_job(tx.db, request.job()));
    if (kind.task != v1::TASK_KIND_UNSPECIFIED) require_results(job);
    switch (kind.task) {
      case v1::TASK_KIND_UNSPECIFIED:
        mesh = kind.kind == v1::ARTIFACT_KIND_SOURCE ? source_of(tx.db, job) : job.mesh_sha256;
        return 0;
      case v1::TASK_KIND_PREPARE: {
        if (job.core_version.empty()) throw missing(tx.db, job, kind.name());
        artifact = find_artifact(tx.db, {job.erosion_id, kind.name(), ""}).value_or(0);
        if (artifact != 0) return 0;
        if (asked != 0) state.error = task_error(tx.db, asked);
        if (state.error) return asked;
        const std::int64_t task = request_prepared(tx, job);
        orphans_.erase(task);
        return task;
      }
      case v1::TASK_KIND_ERODE:
        require_finished(tx.db, job);
        field = job.erosion_id;
        return 0;
      case v1::TASK_KIND_REFINE:
        require_refines(job);
        require_finished(tx.db, job);
        refined = job.erosion_id;
        return 0;
      default:
        break;
    }
    const Derived wanted = derived_artifact(job, kind, request);
    require_finished(tx.db, job);
    artifact = find_artifact(tx.db, wanted.key).value_or(0);
    if (artifact != 0) return 0;
    if (asked != 0) state.error = task_error(tx.db, asked);
    if (state.error) return asked;
    const std::int64_t task = request_derived(tx, job, wanted);
    orphans_.erase(task);
    return task;
  });
  if (!mesh.empty()) state.reader = read_mesh(file_, mesh);
  if (field != 0) state.reader = read_field(file_, field);
  if (refined != 0) state.reader = read_refined(file_, refined);
  if (artifact != 0) state.reader = read_artifact(file_, artifact);
  return state;
}

void Store::withdraw(std::int64_t task) {
  write([&](Tx& tx) {
    const std::optional<TaskRow> row = find_task(tx.db, task);
    // A task of the job itself stays, waited for or not.
    if (!row || !row->on_request) return false;
    tx.db.run("DELETE FROM tasks WHERE id = ?", task);
    tx.changes.jobs.insert(row->job_id);
    add_event(tx, row->job_id, task_event("request_withdrawn", *row, "nobody waits for it any more"));
    return true;
  });
}

void Store::fail_damaged(const std::string& token, const std::string& why, bool retryable) {
  v1::JobError error;
  error.set_code(kDamagedCode);
  error.set_message(why);
  try {
    fail(token, error, retryable);
  } catch (const std::exception& failed) {
    // The lease has ended, or the disk takes nothing: the next one finds the damage again.
    spdlog::warn(base::logfmt("damage_not_told", {{"code", error.code()}, {"message", failed.what()}}));
  }
}

namespace {

/// An input of a task, which fails when its input is damaged: the worker would only ask again.
class InputReader final : public BlobReader {
 public:
  using OnDamage = std::function<void(const std::string& why, bool retryable)>;

  InputReader(const std::function<std::unique_ptr<BlobReader>()>& open, OnDamage on_damage)
      : on_damage_(std::move(on_damage)) {
    guarded([&] { source_ = open(); });
    bytes_ = source_->bytes();
    sha256_ = source_->sha256();
  }

  std::string next() override {
    std::string piece;
    guarded([&] { piece = source_->next(); });
    return piece;
  }

 private:
  template <typename Body>
  void guarded(Body&& body) {
    try {
      body();
    } catch (const StoreError& error) {
      if (error.code() == StoreError::Code::kDamaged) on_damage_(error.what(), false);
      throw;
    } catch (const SqliteError& error) {
      // A disk may fail a read once.
      if (error.says_damaged()) on_damage_(error.what(), true);
      throw;
    }
  }

  OnDamage on_damage_;
  std::unique_ptr<BlobReader> source_;
};

}  // namespace

std::unique_ptr<BlobReader> Store::open_input(const std::string& token, v1::ArtifactKind kind,
                                              std::optional<std::int64_t> known) {
  std::string mesh;
  std::int64_t field = 0, refined = 0;
  std::int64_t artifact = 0;
  read([&](Database& db) {
    const JobRow job = get_job(db, task_of_token(db, token).job_id);
    const wire::ArtifactKindInfo* info = wire::find_artifact_kind(kind);
    if (info == nullptr || info->derived() || kind == v1::ARTIFACT_KIND_SOURCE) {
      throw StoreError(StoreError::Code::kInvalid, "not an input of a task");
    }
    if (info->task == v1::TASK_KIND_UNSPECIFIED) mesh = job.mesh_sha256;
    if (info->task == v1::TASK_KIND_PREPARE) artifact = stored_artifact(db, job, info->name());
    if (info->task == v1::TASK_KIND_ERODE) field = job.erosion_id;
    if (info->task == v1::TASK_KIND_REFINE) {
      require_refines(job);
      refined = job.erosion_id;
    }
    return true;
  });
  const auto open = [&]() -> std::unique_ptr<BlobReader> {
    if (!mesh.empty()) return read_mesh(file_, mesh);
    if (field != 0) return read_field(file_, field);
    if (refined != 0 && known) return read_refined_changes(file_, refined, *known);
    if (refined != 0) return read_refined(file_, refined);
    return read_artifact(file_, artifact);
  };
  return std::make_unique<InputReader>(
      open, [this, token](const std::string& why, bool retryable) { fail_damaged(token, why, retryable); });
}

}  // namespace affskel::server

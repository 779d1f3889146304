#include "store/task_rows.h"

#include <string_view>
#include <utility>

#include "database/errors.h"
#include "store/memory_need.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

v1::TaskKind kind_of(const std::string& name) {
  if (const auto kind = wire::value_of_word<v1::TaskKind>(name)) return *kind;
  throw StoreError(StoreError::Code::kUnusable, "unknown kind of task '" + name + "' in the database");
}

constexpr const char* kTaskColumns =
    "SELECT id, job_id, kind, state, on_request, first_position, end_position, params, params_key, losses,"
    " worker, host, core_version, granted_ms, reported_ms, lease_directions, round FROM tasks ";

TaskRow read_task(const Statement& row) {
  Columns columns(row);
  TaskRow task;
  task.id = columns.integer();
  task.job_id = columns.text();
  task.kind = kind_of(columns.text());
  task.state = columns.text();
  task.on_request = columns.flag();
  task.block.begin = columns.integer();
  task.block.end = columns.integer();
  task.params = columns.blob();
  task.params_key = columns.text();
  task.losses = columns.integer();
  task.worker = columns.text();
  task.host = columns.text();
  task.core_version = columns.text();
  task.granted_ms = columns.integer();
  task.reported_ms = columns.integer_or_null();
  task.lease_directions = columns.integer();
  task.round = columns.integer();
  return task;
}

/// What a new task has beside its job.
struct NewTask {
  v1::TaskKind kind = v1::TASK_KIND_UNSPECIFIED;
  bool on_request = false;
  std::optional<Range> block;  // ERODE, REFINE
  std::optional<Blob> params;  // of the derived kinds
  std::optional<std::string> params_key;
  std::optional<std::int64_t> round;  // REFINE
};

/// Adds a task in its place in the queue: what decides it is copied from the job, and triggers keep it so.
std::int64_t enqueue(Tx& tx, const std::string& job_id, const NewTask& task) {
  const auto position = [&](std::int64_t Range::*end) {
    return task.block ? std::optional((*task.block).*end) : std::nullopt;
  };
  const std::string params(task.params ? task.params->bytes : std::string_view());
  tx.db.run(
      "INSERT INTO tasks (job_id, kind, state, on_request, first_position, end_position, params, params_key,"
      " seq, priority, owner, turn, parked, needs_memory, needs_core, round)"
      " SELECT j.id, ?2, 'pending', ?3, ?4, ?5, ?6, ?7, j.seq, j.priority, j.owner,"
      "  ifnull((SELECT max(turn) FROM tasks WHERE job_id = j.id), 0),"
      "  ?2 = 'verify' OR ?3 = 0 AND (j.state NOT IN ('queued', 'running') OR j.cancel_requested = 1), ?8,"
      "  iif(?2 IN ('erode', 'refine', 'verify') OR (?2 = 'prepare' AND ?3 = 1), ifnull(e.core_version, ''), ''), ?9"
      " FROM jobs j JOIN erosions e ON e.id = j.erosion_id WHERE j.id = ?1",
      job_id, wire::word(task.kind), task.on_request, position(&Range::begin), position(&Range::end),
      task.params, task.params_key, memory_need_of(tx.db, job_id, task.kind, params), task.round);
  tx.changes.work = true;
  return tx.db.last_insert_rowid();
}

}  // namespace

std::optional<TaskRow> find_task(Database& db, std::int64_t id) {
  static const std::string sql = std::string(kTaskColumns) + "WHERE id = ?";
  Statement row = db.query(sql.c_str(), id);
  if (!row.step()) return std::nullopt;
  return read_task(row);
}

std::optional<TaskRow> find_task_of_token(Database& db, const std::string& token) {
  static const std::string sql = std::string(kTaskColumns) + "WHERE token = ?1 OR late_token = ?1";
  Statement row = db.query(sql.c_str(), token);
  if (!row.step()) return std::nullopt;
  return read_task(row);
}

TaskRow task_of_token(Database& db, const std::string& token) {
  if (std::optional<TaskRow> task = find_task_of_token(db, token)) return *std::move(task);
  throw StoreError(StoreError::Code::kFenced, "the lease has ended; its work goes on elsewhere");
}

std::vector<TaskRow> leased_tasks(Database& db) {
  static const std::string sql = std::string(kTaskColumns) + "WHERE state = 'leased'";
  std::vector<TaskRow> leased;
  Statement row = db.query(sql.c_str());
  while (row.step()) leased.push_back(read_task(row));
  return leased;
}

std::int64_t add_task(Tx& tx, const std::string& job_id, v1::TaskKind kind) {
  NewTask task;
  task.kind = kind;
  return enqueue(tx, job_id, task);
}

std::int64_t add_prepare_request(Tx& tx, const std::string& job_id) {
  NewTask task;
  task.kind = v1::TASK_KIND_PREPARE;
  task.on_request = true;
  return enqueue(tx, job_id, task);
}

std::int64_t add_block(Tx& tx, const std::string& job_id, Range block) {
  NewTask task;
  task.kind = v1::TASK_KIND_ERODE;
  task.block = block;
  return enqueue(tx, job_id, task);
}

std::int64_t add_point_block(Tx& tx, const std::string& job_id, std::int64_t round, Range block) {
  NewTask task;
  task.kind = v1::TASK_KIND_REFINE;
  task.block = block;
  task.round = round;
  return enqueue(tx, job_id, task);
}

std::int64_t add_derive_task(Tx& tx, const std::string& job_id, v1::TaskKind kind, const std::string& params,
                             const std::string& params_key, bool on_request) {
  return enqueue(tx, job_id, {kind, on_request, std::nullopt, Blob{params}, params_key, std::nullopt});
}

std::int64_t add_sample_task(Tx& tx, const std::string& job_id, const std::string& positions,
                             std::int64_t sample) {
  return enqueue(
      tx, job_id,
      {v1::TASK_KIND_VERIFY, true, std::nullopt, Blob{positions}, std::to_string(sample), std::nullopt});
}

}  // namespace affskel::server

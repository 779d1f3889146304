#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "affskel/v1/worker_service.pb.h"
#include "store/rows.h"
#include "store/tx.h"

namespace affskel::server {

/// A unit of work with its lease.
struct TaskRow {
  std::int64_t id = 0;
  std::string job_id;
  v1::TaskKind kind = v1::TASK_KIND_UNSPECIFIED;
  std::string state;
  bool on_request = false;
  Range block;             // ERODE: positions; REFINE: points
  std::int64_t round = 0;  // REFINE
  std::string params;      // of the derived kinds: serialized
  std::string params_key;
  std::int64_t losses = 0;
  std::string worker;
  std::string host;
  std::string core_version;
  std::int64_t granted_ms = 0;
  std::optional<std::int64_t> reported_ms;
  std::int64_t lease_directions = 0;
};

std::optional<TaskRow> find_task(Database& db, std::int64_t id);

/// The task that holds this token: leased, done, or pending when its worker was silent and no other has
/// taken it since.
std::optional<TaskRow> find_task_of_token(Database& db, const std::string& token);
/// The same.  @throws StoreError kFenced when there is none.
TaskRow task_of_token(Database& db, const std::string& token);

/// Adds a pending task in its place in the queue.  `block` for ERODE, `params` and `params_key` for the
/// derived kinds.
std::int64_t add_task(Tx& tx, const std::string& job_id, v1::TaskKind kind);
/// A client asks for lattice or directions that are lost.
std::int64_t add_prepare_request(Tx& tx, const std::string& job_id);
std::int64_t add_block(Tx& tx, const std::string& job_id, Range block);
std::int64_t add_point_block(Tx& tx, const std::string& job_id, std::int64_t round, Range block);
std::int64_t add_derive_task(Tx& tx, const std::string& job_id, v1::TaskKind kind, const std::string& params,
                             const std::string& params_key, bool on_request);

/// Directions to be computed again by a worker that did not give them, see store/verification.h.
std::int64_t add_sample_task(Tx& tx, const std::string& job_id, const std::string& positions,
                             std::int64_t sample);

/// All tasks that are leased.
std::vector<TaskRow> leased_tasks(Database& db);

}  // namespace affskel::server

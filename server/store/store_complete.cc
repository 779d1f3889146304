#include <algorithm>
#include <cmath>
#include <exception>
#include <numeric>

#include "base/number_text.h"
#include "base/quoted.h"
#include "database/errors.h"
#include "store/blocks.h"
#include "store/job_events.h"
#include "store/job_life.h"
#include "store/memory_need.h"
#include "store/quota.h"
#include "store/store_impl.h"
#include "store/task_leases.h"
#include "store/task_rows.h"
#include "wire/artifact_kinds.h"
#include "wire/sha256.h"

namespace affskel::server {
namespace {

// No machine's memory is larger, bytes: a task that needed more would wait for ever.
constexpr std::uint64_t kMaxMemory = std::uint64_t{1} << 48;

// Kept and sent with the job from then on: reasons of failure, advice on a skeleton.
constexpr std::size_t kMaxReasonBytes = 4000;

[[noreturn]] void refuse_completion(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, "result: " + why);
}

bool positive(double value) {
  return std::isfinite(value) && value > 0;
}

bool all_finite(const google::protobuf::RepeatedField<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// A prepare result taken apart.
struct Prepared {
  std::string_view lattice;
  std::string_view directions;
};

void check_lattice(std::string_view bytes, std::uint64_t points) {
  v1::Lattice lattice;
  if (!lattice.ParseFromArray(bytes.data(), static_cast<int>(bytes.size())))
    refuse_completion("the lattice cannot be read");
  if (lattice.origin_size() != 3 || lattice.axes_size() != 9 || lattice.dims_size() != 3 ||
      lattice.run_start_size() != lattice.run_length_size()) {
    refuse_completion("the lattice is malformed");
  }
  if (!all_finite(lattice.origin()) || !all_finite(lattice.axes()))
    refuse_completion("a place of the lattice is not finite");
  const std::uint64_t inside =
      std::accumulate(lattice.run_length().begin(), lattice.run_length().end(), std::uint64_t{0});
  if (inside != points) {
    refuse_completion("the lattice has " + std::to_string(inside) + " points inside, the summary says " +
                      std::to_string(points));
  }
}

void check_directions(std::string_view bytes, std::uint64_t count) {
  v1::Directions directions;
  if (!directions.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    refuse_completion("the directions cannot be read");
  }
  if (static_cast<std::uint64_t>(directions.xyz_size()) != 3 * count) {
    refuse_completion("not 3 numbers for each of the " + std::to_string(count) + " directions");
  }
  if (!all_finite(directions.xyz())) refuse_completion("a direction is not finite");
}

Prepared checked_prepared(const v1::CompleteTaskHeader& header, std::string_view data) {
  const v1::PreparedSummary& summary = header.prepared();
  if (!header.has_prepared()) refuse_completion("no summary");
  if (summary.directions() < 1 || summary.directions() >= wire::kNoDirection)
    refuse_completion("the number of directions");
  if (summary.points() > 0xFFFFFFFF) refuse_completion("more than 2^32 - 1 sample points");
  if (!positive(summary.volume()) || !positive(summary.spacing()))
    refuse_completion("volume and spacing must be > 0");
  if (summary.bbox_min_size() != 3 || summary.bbox_max_size() != 3 || !all_finite(summary.bbox_min()) ||
      !all_finite(summary.bbox_max())) {
    refuse_completion("the bounding box must be 3 + 3 finite numbers");
  }
  if (header.order_stride() < 1 || std::gcd(header.order_stride(), summary.directions()) != 1 ||
      header.order_stride() > summary.directions()) {
    refuse_completion("the stride must be 1 .. directions and coprime to their number");
  }
  if (header.lattice_bytes() > data.size()) refuse_completion("the lattice is longer than the data");
  const Prepared parts{data.substr(0, header.lattice_bytes()), data.substr(header.lattice_bytes())};
  check_lattice(parts.lattice, summary.points());
  check_directions(parts.directions, summary.directions());
  return parts;
}

void store_prepared(Tx& tx, const TaskRow& task, const v1::CompleteTaskHeader& header,
                    const Prepared& parts) {
  const JobRow job = get_job(tx.db, task.job_id);
  const v1::PreparedSummary& summary = header.prepared();
  const v1::Frame asked = job_message(tx.db, job.id).params().frame();
  if (asked != v1::FRAME_UNSPECIFIED && asked != v1::FRAME_AXIS && summary.frame_size() != 9) {
    refuse_completion("prepared without the frame that was asked for; the worker is older than frames");
  }
  const std::string bytes = summary.SerializeAsString();
  tx.db.run(
      "UPDATE erosions SET core_version = ?, prepared = ?, points = ?, directions = ?, stride = ?"
      " WHERE id = ?",
      task.core_version, Blob{bytes}, summary.points(), summary.directions(), header.order_stride(),
      job.erosion_id);
  put_artifact(tx, {job.erosion_id, "lattice", ""}, parts.lattice, 0);
  put_artifact(tx, {job.erosion_id, "directions", ""}, parts.directions, 0);
  end_stage(tx, job.id);
  tx.db.run("UPDATE jobs SET stage = 'erode' WHERE id = ?", job.id);
  cut_blocks(tx, job.id, static_cast<std::int64_t>(summary.directions()));
  add_event(tx, job.id,
            {.event = "prepared",
             .message = base::counted(summary.triangles(), "triangle") + ", " +
                        base::counted(summary.points(), "sample point") + ", " +
                        base::counted(summary.directions(), "direction")});
}

/// Lattice and directions that a damaged disk has lost, made again for a field that is there.
void restore_prepared(Tx& tx, const TaskRow& task, const v1::CompleteTaskHeader& header,
                      const Prepared& parts) {
  const JobRow job = get_job(tx.db, task.job_id);
  Statement row = tx.db.query("SELECT prepared, stride FROM erosions WHERE id = ?", job.erosion_id);
  if (!row.step() || row.blob(0) != header.prepared().SerializeAsString() ||
      static_cast<std::uint64_t>(row.integer(1)) != header.order_stride()) {
    refuse_completion("prepared anew, the job has another lattice or other directions than its field");
  }
  put_artifact(tx, {job.erosion_id, "lattice", ""}, parts.lattice, 0);
  put_artifact(tx, {job.erosion_id, "directions", ""}, parts.directions, 0);
}

void store_derived(Tx& tx, const TaskRow& task, const v1::CompleteTaskHeader& header, std::string_view data) {
  if (header.points() > 0xFFFFFFFF) refuse_completion("more than 2^32 - 1 points or vertices");
  const JobRow job = get_job(tx.db, task.job_id);
  if (header.quality().advice().size() > kMaxReasonBytes)
    refuse_completion("the advice on the skeleton is too long");
  put_artifact(tx, {job.erosion_id, wire::find_derived_kind(task.kind)->name(), task.params_key}, data,
               static_cast<std::int64_t>(header.points()),
               header.has_quality() ? header.quality().SerializeAsString() : std::string());
}

std::string known_code(const std::string& code) {
  for (const char* known : {"BAD_INPUT", "LIMIT", "WORKER_LOST", "DAMAGED", "INTERNAL"}) {
    if (code == known) return code;
  }
  return "INTERNAL";
}

}  // namespace

v1::ReportResponse Store::complete(const v1::CompleteTaskHeader& header, std::string_view data) {
  if (data.size() != header.bytes()) {
    refuse_completion("announced with " + std::to_string(header.bytes()) + " bytes, but " +
                      std::to_string(data.size()) + " arrived");
  }
  if (wire::sha256_hex(data) != header.sha256())
    refuse_completion("the data does not have the announced SHA-256");
  const std::optional<Prepared> parts =
      header.has_prepared() ? std::optional(checked_prepared(header, data)) : std::nullopt;
  const v1::TaskKind kind = read([&](Database& db) { return task_of_token(db, header.token()).kind; });
  if (kind == v1::TASK_KIND_VERIFY && !parts) return complete_sample(header.token(), data);
  std::exception_ptr refusal;
  const v1::ReportResponse response = write([&](Tx& tx) {
    const TaskRow task = held_task(tx, header.token());
    if (task.state == "done") return reply(false);
    tx.changes.jobs.insert(task.job_id);
    tx.changes.results.emplace(task.id, task.job_id);
    if (!tx.room) {
      refusal = refuse_for_now(tx, task);
      return reply(false);
    }
    tx.require_room();
    if (parts && task.on_request && task.kind == v1::TASK_KIND_PREPARE) {
      restore_prepared(tx, task, header, *parts);
      finish_task(tx, task);
      return reply(false);
    }
    if (task.kind == v1::TASK_KIND_ERODE || task.kind == v1::TASK_KIND_REFINE)
      refuse_completion("a block is finished by its reports");
    if ((task.kind == v1::TASK_KIND_PREPARE) != parts.has_value()) {
      refuse_completion("a summary belongs to the prepare task, and only to it");
    }
    if (parts) {
      const JobRow job = get_job(tx.db, task.job_id);
      if (const auto error = over_quota(tx.db, options_.policy, job.owner, header.prepared(), job.refines,
                                        static_cast<std::int64_t>(data.size()))) {
        give_up(tx, task, *error);
        settle_job(tx, task.job_id);
        return reply(true);
      }
      store_prepared(tx, task, header, *parts);
    } else {
      const JobRow job = get_job(tx.db, task.job_id);
      if (const auto error =
              over_stored_room(tx.db, options_.policy, job.owner, static_cast<std::int64_t>(data.size()))) {
        give_up(tx, task, *error);
        settle_job(tx, task.job_id);
        return reply(true);
      }
      store_derived(tx, task, header, data);
    }
    finish_task(tx, task);
    settle_job(tx, task.job_id);
    return reply(false);
  });
  if (refusal) std::rethrow_exception(refusal);
  return response;
}

namespace {

/// The task waits for a worker with more memory, the first time for one with what this one says is needed.
void wait_for_larger(Tx& tx, const TaskRow& task, std::uint64_t bytes) {
  const auto known = static_cast<std::uint64_t>(
      tx.db.integer("SELECT needs_memory FROM tasks WHERE id = ?", task.id).value_or(0));
  tx.db.run("UPDATE tasks SET needs_memory = ? WHERE id = ?", rounded_need(std::max(bytes, known + 1)),
            task.id);
  release_task(tx, task);
  settle_job(tx, task.job_id);
}

}  // namespace

v1::ReportResponse Store::fail(const std::string& token, const v1::JobError& error, bool retryable,
                               std::uint64_t memory_needed) {
  if (memory_needed > kMaxMemory) {
    throw StoreError(StoreError::Code::kInvalid,
                     "no machine has the " + std::to_string(memory_needed) + " bytes of memory_needed");
  }
  v1::JobError known = error;
  known.set_code(known_code(error.code()));
  known.set_message(base::shortened(error.message(), kMaxReasonBytes));
  if (known.message().empty()) known.set_message("the worker gave no reason");
  return write([&](Tx& tx) {
    const TaskRow task = held_task(tx, token);
    if (task.state == "done") return reply(false);
    add_event(tx, task.job_id,
              task_event("task_failed", task,
                         known.code() +
                             (memory_needed > 0 ? " (waits for a larger worker): "
                              : retryable       ? " (to be tried again): "
                                                : ": ") +
                             known.message()));
    if (memory_needed > 0) {
      wait_for_larger(tx, task, memory_needed);
    } else if (retryable) {
      count_loss(tx, task, known);
    } else {
      give_up(tx, task, known);
      settle_job(tx, task.job_id);
    }
    return reply(false);
  });
}

}  // namespace affskel::server

#include <exception>
#include <utility>

#include "base/refine_rounds.h"
#include "database/errors.h"
#include "store/givers.h"
#include "store/job_life.h"
#include "store/refinement.h"
#include "store/store_impl.h"
#include "store/task_leases.h"
#include "store/task_rows.h"
#include "wire/words.h"

namespace affskel::server {
namespace {

// Of a report on a refinement: every value is looked for in them.  What is left of a block has a few.
constexpr int kMostPointRanges = 256;

[[noreturn]] void refuse_report(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, "report: " + why);
}

TaskRow of_kind(v1::TaskKind kind, TaskRow task) {
  if (task.kind != kind) refuse_report("the lease is for a " + wire::word(task.kind) + " task");
  return task;
}

TaskRow of_erosion(TaskRow task) {
  return of_kind(v1::TASK_KIND_ERODE, std::move(task));
}

/// The finished ranges of a report, checked against the block.
std::vector<Range> checked_ranges(const v1::ReportErosionHeader& header, Range block) {
  // Each range costs a query with the database locked; there cannot be more of them than positions.
  if (header.positions_done_size() > block.end - block.begin) {
    refuse_report(std::to_string(header.positions_done_size()) + " ranges in a block of " +
                  std::to_string(block.end - block.begin) + " positions");
  }
  std::vector<Range> ranges;
  for (const v1::PositionRange& range : header.positions_done()) {
    if (range.begin() >= range.end() || range.begin() < static_cast<std::uint64_t>(block.begin) ||
        range.end() > static_cast<std::uint64_t>(block.end)) {
      refuse_report("positions [" + std::to_string(range.begin()) + ", " + std::to_string(range.end()) +
                    ") are not a range inside the block [" + std::to_string(block.begin) + ", " +
                    std::to_string(block.end) + ")");
    }
    ranges.push_back({static_cast<std::int64_t>(range.begin()), static_cast<std::int64_t>(range.end())});
  }
  return ranges;
}

/// A report that is repeated after its block was finished brings what is merged already, and the job may have come to
/// refining since.
bool takes_records(const JobRow& job, const TaskRow& task) {
  return !job.finished && task.state != "done";
}

struct Progress {
  std::int64_t reported = 0;  // directions; of a refinement points
  std::int64_t added = 0;
};

void require_round(const v1::ReportErosionHeader& header, const TaskRow& task) {
  if (header.round() == task.round) return;
  refuse_report("of round " + std::to_string(header.round()) + ", the lease is for round " +
                std::to_string(task.round));
}

Progress add_positions(Tx& tx, const JobRow& job, const std::vector<Range>& ranges) {
  Progress progress;
  for (const Range& range : ranges) {
    progress.reported += range.end - range.begin;
    progress.added += add_done_range(tx.db, job.erosion_id, range);
  }
  if (progress.added > 0) {
    tx.db.run("UPDATE erosions SET directions_done = directions_done + ? WHERE id = ?", progress.added,
              job.erosion_id);
  }
  return progress;
}

void count_report(Tx& tx, const TaskRow& task, const Progress& progress) {
  const bool directions = task.kind == v1::TASK_KIND_ERODE;
  const std::int64_t gap = task.state == "leased" ? pause_ms(tx, task) : 0;
  std::string owner;
  {
    Statement row = tx.db.query(
        "UPDATE jobs SET reports = reports + 1, directions_reported = directions_reported + ?,"
        " directions_repeated = directions_repeated + ?, longest_gap_ms = max(longest_gap_ms, ?) WHERE id = ?"
        " RETURNING owner",
        directions ? progress.reported : 0, directions ? progress.reported - progress.added : 0, gap,
        task.job_id);
    while (row.step()) owner = row.text(0);
  }
  if (directions) {
    tx.changes.counts.push_back([owner, progress](Metrics& metrics) {
      metrics.directions(owner, progress.added, progress.reported - progress.added);
    });
  } else {
    tx.changes.counts.push_back([progress](Metrics& metrics) {
      metrics.refined_points(progress.added, progress.reported - progress.added);
    });
  }
  tx.db.run(
      "UPDATE tasks SET reported_ms = ?, waited_ms = NULL, lease_directions = lease_directions + ?,"
      " losses = iif(? > 0, 0, losses) WHERE id = ?",
      tx.lease_ms, progress.reported, progress.added, task.id);
  if (progress.added > 0 && task.state == "leased") {
    tx.db.run("UPDATE tasks SET stalled_ms = ? WHERE id = ?", tx.lease_ms + patience_ms(tx, task), task.id);
  }
}

}  // namespace

Store::BlockLease Store::block_lease(const std::string& token) {
  return read([&](Database& db) {
    const TaskRow task = task_of_token(db, token);
    if (task.kind != v1::TASK_KIND_REFINE) of_erosion(task);
    const JobRow job = get_job(db, task.job_id);
    return BlockLease{job.id,         field_name(db, job.erosion_id),    task.worker, task.kind,
                      job.directions, refined_bounds(db, job.erosion_id)};
  });
}

/// A transaction that merges into the field of a lease's job.  When the field turns out to be damaged, the
/// job fails with the reason, and the workers are free for others.
template <typename Body>
auto Store::write_field(const std::string& token, Body&& body) {
  try {
    return write(body);
  } catch (const StoreError& error) {
    if (error.code() == StoreError::Code::kDamaged) fail_damaged(token, error.what(), false);
    throw;
  } catch (const SqliteError& error) {
    if (error.says_damaged()) fail_damaged(token, error.what(), true);
    throw;
  }
}

Store::Reported Store::report(const v1::ReportErosionHeader& header, const RecordBatch& records) {
  std::exception_ptr refusal;
  JobRow reported;
  bool merged = false;
  const v1::ReportResponse response = write_field(header.token(), [&](Tx& tx) {
    const TaskRow task = of_erosion(held_task(tx, header.token()));
    const JobRow job = get_job(tx.db, task.job_id);
    tx.changes.jobs.insert(job.id);
    tx.changes.results.emplace(task.id, job.id);
    if (!tx.room) {
      refusal = refuse_for_now(tx, task);
      return reply(false);
    }
    tx.require_room();
    const std::vector<Range> ranges = checked_ranges(header, task.block);
    const Progress progress = add_positions(tx, job, ranges);
    reported = job;
    reported.directions_done += progress.added;
    merged = takes_records(job, task);
    if (merged) {
      note_given(tx.db, job, {task.worker, task.host}, ranges, records.records());
      merge_records(tx.db, job.erosion_id, job.points, records.records());
    }
    count_report(tx, task, progress);
    if (task.state == "done") return reply(false);
    if (header.block_done()) {
      if (!remaining_ranges(tx.db, job.erosion_id, task.block).empty()) {
        refuse_report("the block is called done, but not all of its positions are");
      }
      finish_task(tx, task);
    } else if (!job.active() || job.cancel_requested) {
      release_task(tx, task);
    } else {
      renew_lease(tx, task);
      return reply(false);
    }
    settle_job(tx, job.id);
    return reply(!job.active() || job.cancel_requested);
  });
  if (refusal) std::rethrow_exception(refusal);
  times_left_.add(reported.id, clock_.lease_ms(), static_cast<std::uint64_t>(reported.directions_done),
                  static_cast<std::uint64_t>(reported.directions));
  return {response, merged};
}

v1::ReportResponse Store::report_refined(const v1::ReportErosionHeader& header, const RefinedBatch& batch) {
  std::exception_ptr refusal;
  JobRow reported;
  const v1::ReportResponse response = write_field(header.token(), [&](Tx& tx) {
    const TaskRow task = of_kind(v1::TASK_KIND_REFINE, held_task(tx, header.token()));
    const JobRow job = get_job(tx.db, task.job_id);
    tx.changes.jobs.insert(job.id);
    tx.changes.results.emplace(task.id, job.id);
    require_round(header, task);
    // A report that is repeated after its block was finished may find the next round begun.
    if (task.state == "done") return reply(false);
    if (!tx.room) {
      refusal = refuse_for_now(tx, task);
      return reply(false);
    }
    tx.require_room();
    if (header.positions_done_size() > kMostPointRanges)
      refuse_report("more than " + std::to_string(kMostPointRanges) + " ranges of points");
    const std::vector<Range> ranges = checked_ranges(header, task.block);
    Progress progress;
    for (const Range& range : ranges) progress.reported += range.end - range.begin;
    progress.added = take_refined(tx, job, task, ranges, batch.records());
    reported = job;
    reported.refined_points += progress.added;
    count_report(tx, task, progress);
    const bool cancelled = !job.active() || job.cancel_requested;
    if (header.block_done()) {
      if (!left_of_block(tx.db, job, task).empty())
        refuse_report("the block is called done, but not all of its points are");
      finish_task(tx, task);
    } else if (cancelled) {
      release_task(tx, task);
    } else {
      renew_lease(tx, task);
      return reply(false);
    }
    settle_job(tx, job.id);
    return reply(cancelled);
  });
  if (refusal) std::rethrow_exception(refusal);
  if (reported.points > 0) {
    const std::int64_t begun =
        base::refine_points_begun(reported.round, reported.refined_points, reported.points);
    times_left_.add(reported.id, clock_.lease_ms(), static_cast<std::uint64_t>(begun),
                    static_cast<std::uint64_t>(reported.points));
  }
  return response;
}

bool Store::report_part(const std::string& token, const RecordBatch& records) {
  std::exception_ptr refusal;
  const bool merged = write_field(token, [&](Tx& tx) {
    const TaskRow task = of_erosion(held_task(tx, token));
    const JobRow job = get_job(tx.db, task.job_id);
    tx.changes.jobs.insert(job.id);
    tx.changes.results.emplace(task.id, job.id);
    if (!tx.room) {
      refusal = refuse_for_now(tx, task);
      return false;
    }
    tx.require_room();
    tx.changes.partly = true;
    const bool merges = takes_records(job, task);
    if (merges) {
      note_given(tx.db, job, {task.worker, task.host}, {}, records.records());
      merge_records(tx.db, job.erosion_id, job.points, records.records());
    }
    if (task.state == "leased") renew_lease(tx, task);
    return merges;
  });
  if (refusal) std::rethrow_exception(refusal);
  return merged;
}

}  // namespace affskel::server

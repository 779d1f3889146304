#include "store/refinement.h"

#include <algorithm>
#include <string>

#include "base/refine_rounds.h"
#include "database/errors.h"
#include "store/blocks.h"
#include "store/field.h"
#include "store/field_rows.h"
#include "wire/field_record.h"

namespace affskel::server {
namespace {

// Every reader keeps the log in memory: more than this, and the rounds before the last go into the chunks.
constexpr std::int64_t kMaxRefinedLog = std::int64_t{32} << 20;

[[noreturn]] void refuse_values(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, "report: " + why);
}

/// Ascending.
std::vector<std::uint32_t> changed_in(Database& db, const JobRow& job) {
  std::vector<std::uint32_t> changed;
  visit_refined_log(db, job.erosion_id, job.round - 1, job.round, [&](std::string_view bytes) {
    for (; !bytes.empty(); bytes.remove_prefix(wire::kRefinedPointRecordBytes))
      changed.push_back(wire::decode_refined_point_record(bytes.data()).point);
  });
  std::sort(changed.begin(), changed.end());
  return changed;
}

void begin_round(Tx& tx, const JobRow& job, std::int64_t round) {
  tx.db.run("DELETE FROM refined_ranges WHERE erosion_id = ?", job.erosion_id);
  tx.db.run("UPDATE erosions SET round = ?, refined_points = 0 WHERE id = ?", round, job.erosion_id);
}

bool within(const std::vector<Range>& ranges, std::int64_t point) {
  return std::any_of(ranges.begin(), ranges.end(),
                     [&](const Range& range) { return range.begin <= point && point < range.end; });
}

/// The set's E of points that ascend, chunk by chunk.
class Seeds {
 public:
  Seeds(Database& db, std::int64_t erosion_id) : db_(db), erosion_id_(erosion_id) {}

  double erosion(std::uint32_t point) {
    const std::int64_t index = point / kChunkPoints;
    if (index != index_) chunk_ = load_chunk(db_, erosion_id_, index);
    index_ = index;
    const std::size_t at = (point - static_cast<std::size_t>(index * kChunkPoints)) * wire::kFieldRecordBytes;
    return wire::decode_field_record(chunk_.data() + at).erosion;
  }

 private:
  Database& db_;
  std::int64_t erosion_id_;
  std::int64_t index_ = -1;
  std::string chunk_;
};

void require_below_seeds(Database& db, const JobRow& job,
                         const std::vector<wire::RefinedPointRecord>& records) {
  Seeds seeds(db, job.erosion_id);
  for (const wire::RefinedPointRecord& record : records) {
    if (record.record.erosion <= seeds.erosion(record.point) * kMostOfSeed) continue;
    refuse_values("E of point " + std::to_string(record.point) +
                  " is above that of the set of directions, where it begins");
  }
}

}  // namespace

void begin_refinement(Tx& tx, const JobRow& job) {
  begin_round(tx, job, 0);
  cut_point_blocks(tx, job.id, 0, job.points, nullptr);
}

bool finish_round(Tx& tx, const JobRow& job) {
  if (job.refined_points != job.points) {
    throw StoreError(StoreError::Code::kDamaged, "job " + job.id + ": all blocks are done, but only " +
                                                     std::to_string(job.refined_points) + " of " +
                                                     std::to_string(job.points) + " points");
  }
  const bool first = job.round == 0;
  const std::vector<std::uint32_t> changed = first ? std::vector<std::uint32_t>() : changed_in(tx.db, job);
  if ((first ? job.points == 0 : changed.empty()) || job.round == base::kMostRefineRounds) {
    merge_refined_log(tx.db, job.erosion_id, job.points, job.round);
    return true;
  }
  if (refined_log_bytes(tx.db, job.erosion_id) > kMaxRefinedLog)
    merge_refined_log(tx.db, job.erosion_id, job.points, job.round - 1);
  begin_round(tx, job, job.round + 1);
  // Those of this round stay for reports that are repeated, and go with the next.
  tx.db.run("DELETE FROM tasks WHERE job_id = ? AND kind = 'refine' AND round < ?", job.id, job.round);
  cut_point_blocks(tx, job.id, job.round + 1, job.points, first ? nullptr : &changed);
  return false;
}

void forget_refinement(Tx& tx, std::int64_t erosion_id) {
  for (const char* sql :
       {"DELETE FROM refined_chunks WHERE erosion_id = ?", "DELETE FROM refined_log WHERE erosion_id = ?",
        "DELETE FROM refined_ranges WHERE erosion_id = ?", "DELETE FROM refined_givers WHERE erosion_id = ?",
        "UPDATE erosions SET round = NULL, refined_points = 0 WHERE id = ?"}) {
    tx.db.run(sql, erosion_id);
  }
}

std::int64_t take_refined(Tx& tx, const JobRow& job, const TaskRow& task, const std::vector<Range>& ranges,
                          const std::vector<wire::RefinedPointRecord>& records) {
  std::vector<Range> fresh;
  std::int64_t added = 0;
  for (const Range& range : ranges) {
    for (const Range& left : remaining_ranges(tx.db, job.erosion_id, range, Done::kPoints))
      fresh.push_back(left);
    added += add_done_range(tx.db, job.erosion_id, range, Done::kPoints);
  }
  std::vector<wire::RefinedPointRecord> values;
  for (wire::RefinedPointRecord record : records) {
    if (!within(ranges, record.point))
      refuse_values("a value of point " + std::to_string(record.point) + ", which it does not call done");
    if (!within(fresh, record.point)) continue;
    record.record.round = static_cast<std::uint32_t>(job.round);
    values.push_back(record);
  }
  if (job.round == 0 && static_cast<std::int64_t>(values.size()) != added) {
    refuse_values("values of " + std::to_string(values.size()) + " of " + std::to_string(added) +
                  " points that it calls done; in round 0 every point has one");
  }
  require_below_seeds(tx.db, job, values);
  put_refined(tx.db, job.erosion_id, job.points, job.round, values);
  if (added == 0) return 0;
  tx.db.run("UPDATE erosions SET refined_points = refined_points + ? WHERE id = ?", added, job.erosion_id);
  tx.db.run(
      "INSERT INTO refined_givers (erosion_id, worker, host, points) VALUES (?, ?, ?, ?)"
      " ON CONFLICT (erosion_id, worker) DO UPDATE SET points = points + excluded.points",
      job.erosion_id, task.worker, task.host, values.size());
  return added;
}

RefinedBounds refined_bounds(Database& db, std::int64_t erosion_id) {
  Statement row = db.query("SELECT points, prepared FROM erosions WHERE id = ?", erosion_id);
  RefinedBounds bounds;
  v1::PreparedSummary prepared;
  if (row.step()) {
    bounds.points = row.integer(0);
    prepared.ParseFromString(std::string(row.blob(1)));
  }
  bounds.volume = prepared.volume();
  bounds.vertices = static_cast<std::int64_t>(prepared.vertices());
  return bounds;
}

}  // namespace affskel::server

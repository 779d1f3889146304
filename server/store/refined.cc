#include "store/refined.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "database/checksum.h"
#include "database/errors.h"
#include "store/field.h"

namespace affskel::server {
namespace {

using RefinedAt = std::vector<wire::RefinedPointRecord>::const_iterator;

constexpr std::size_t kRefinedBytes = wire::kRefinedRecordBytes;

// Of the volume, by which E may exceed it: as in reports of directions.
constexpr double kVolumeRounding = 1 + 0x1p-30;
constexpr double kUnitRounding = 1e-9;  // of a normal's squared length

[[noreturn]] void refuse_refined(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, "report: " + why);
}

StoreError refined_damage(std::int64_t erosion_id, const std::string& row) {
  return {StoreError::Code::kDamaged,
          "the stored refined field is damaged (erosion " + std::to_string(erosion_id) + ", " + row +
              "); stop the server and run affskel-server check --repair, which has it computed again"};
}

std::string empty_refined_chunk(std::size_t count) {
  char record[kRefinedBytes];
  wire::encode_refined_record(record, {});
  std::string chunk;
  chunk.reserve(count * kRefinedBytes);
  for (std::size_t i = 0; i < count; ++i) chunk.append(record, kRefinedBytes);
  return chunk;
}

/// Empty when it is not there.
std::string load_refined_chunk(Database& db, std::int64_t erosion_id, std::int64_t index) {
  Statement row =
      db.query("SELECT data, sum FROM refined_chunks WHERE erosion_id = ? AND idx = ?", erosion_id, index);
  if (!row.step()) return {};
  if (row.integer(1) != checksum(erosion_id, index, row.blob(0))) {
    throw refined_damage(erosion_id, "chunk " + std::to_string(index) + " does not match its checksum");
  }
  return std::string(row.blob(0));
}

void store_refined_chunk(Database& db, std::int64_t erosion_id, std::int64_t index,
                         const std::string& chunk) {
  db.run(
      "INSERT INTO refined_chunks (erosion_id, idx, data, sum) VALUES (?, ?, ?, ?)"
      " ON CONFLICT (erosion_id, idx) DO UPDATE SET data = excluded.data, sum = excluded.sum",
      erosion_id, index, Blob{chunk}, checksum(erosion_id, index, chunk));
}

/// Later records of a point take the place of earlier ones.
void put_into(std::string& chunk, std::int64_t index, RefinedAt begin, RefinedAt end) {
  for (RefinedAt record = begin; record != end; ++record) {
    const std::size_t at = record->point - static_cast<std::size_t>(index * kChunkPoints);
    wire::encode_refined_record(chunk.data() + at * kRefinedBytes, record->record);
  }
}

/// @param first whether a chunk may be missing: in round 0.
void put_into_chunks(Database& db, std::int64_t erosion_id, std::int64_t points,
                     const std::vector<wire::RefinedPointRecord>& records, bool first) {
  for (auto begin = records.begin(); begin != records.end();) {
    const std::int64_t index = begin->point / kChunkPoints;
    const auto end = std::find_if(begin, records.end(), [&](const wire::RefinedPointRecord& r) {
      return r.point / kChunkPoints != index;
    });
    std::string chunk = load_refined_chunk(db, erosion_id, index);
    if (chunk.empty() && !first)
      throw refined_damage(erosion_id, "chunk " + std::to_string(index) + " is missing");
    if (chunk.empty()) chunk = empty_refined_chunk(field_chunk_points(points, index));
    put_into(chunk, index, begin, end);
    store_refined_chunk(db, erosion_id, index, chunk);
    begin = end;
  }
}

/// The latest of each point, ascending.
std::vector<wire::RefinedPointRecord> latest_of_log(Database& db, std::int64_t erosion_id,
                                                    std::int64_t through) {
  std::vector<wire::RefinedPointRecord> all;
  visit_refined_log(db, erosion_id, 0, through, [&](std::string_view bytes) {
    for (; !bytes.empty(); bytes.remove_prefix(wire::kRefinedPointRecordBytes))
      all.push_back(wire::decode_refined_point_record(bytes.data()));
  });
  std::stable_sort(
      all.begin(), all.end(),
      [](const wire::RefinedPointRecord& a, const wire::RefinedPointRecord& b) { return a.point < b.point; });
  std::vector<wire::RefinedPointRecord> latest;
  for (const wire::RefinedPointRecord& record : all) {
    if (!latest.empty() && latest.back().point == record.point) latest.pop_back();
    latest.push_back(record);
  }
  return latest;
}

}  // namespace

std::string fault_of(const wire::RefinedRecord& record, const RefinedBounds& bounds) {
  if (!(record.erosion > 0 && record.erosion <= bounds.volume * kVolumeRounding))
    return "E is " + base::to_text(record.erosion) + ": not above 0 and at most the volume of the solid";
  if (!std::isfinite(record.slope) || record.slope < 0) return "the slope is negative or not finite";
  double length = 0;
  for (const double x : record.normal) length += x * x;
  if (!(std::abs(length - 1) <= kUnitRounding)) return "the normal is not of unit length";
  for (const std::uint32_t saddle : record.saddles) {
    if (saddle != wire::kNoSaddle && saddle >= bounds.vertices)
      return "saddle " + std::to_string(saddle) + " of " + std::to_string(bounds.vertices) + " vertices";
  }
  return {};
}

void RefinedBatch::append(const v1::RefinedRecords& records) {
  const int count = records.point_size();
  if (records.erosion_size() != count || records.slope_size() != count ||
      records.normal_size() != 3 * count || records.saddle_size() != 2 * count) {
    refuse_refined("the arrays of refined records do not fit each other");
  }
  for (int i = 0; i < count; ++i) {
    wire::RefinedPointRecord named;
    named.point = records.point(i);
    named.record.erosion = records.erosion(i);
    named.record.slope = records.slope(i);
    for (int axis = 0; axis < 3; ++axis)
      named.record.normal[static_cast<std::size_t>(axis)] = records.normal(3 * i + axis);
    for (int n = 0; n < 2; ++n) named.record.saddles[static_cast<std::size_t>(n)] = records.saddle(2 * i + n);
    const std::string point = "point " + std::to_string(named.point);
    if (named.point >= bounds_.points) refuse_refined(point + " of " + std::to_string(bounds_.points));
    if (!records_.empty() && named.point <= records_.back().point)
      refuse_refined(point + " after " + std::to_string(records_.back().point) + ": points must ascend");
    if (const std::string fault = fault_of(named.record, bounds_); !fault.empty())
      refuse_refined(point + ": " + fault);
    records_.push_back(named);
  }
}

void put_refined(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t round,
                 const std::vector<wire::RefinedPointRecord>& records) {
  if (records.empty()) return;
  if (round == 0) return put_into_chunks(db, erosion_id, points, records, true);
  std::string bytes(records.size() * wire::kRefinedPointRecordBytes, '\0');
  char* to = bytes.data();
  for (const wire::RefinedPointRecord& record : records) {
    wire::encode_refined_point_record(to, record);
    to += wire::kRefinedPointRecordBytes;
  }
  db.run("INSERT INTO refined_log (erosion_id, round, data, sum) VALUES (?, ?, ?, ?)", erosion_id, round,
         Blob{bytes}, refined_log_sum(erosion_id, round, bytes));
}

std::vector<std::int64_t> refined_log_rows(Database& db, std::int64_t erosion_id, std::int64_t known,
                                           std::int64_t through) {
  Statement row = db.query(
      "SELECT id FROM refined_log WHERE erosion_id = ? AND round > ? AND round <= ? ORDER BY round, id",
      erosion_id, known, through);
  std::vector<std::int64_t> rows;
  while (row.step()) rows.push_back(row.integer(0));
  return rows;
}

std::string load_refined_log(Database& db, std::int64_t erosion_id, std::int64_t row) {
  Statement found = db.query("SELECT data, sum, round FROM refined_log WHERE id = ?", row);
  const std::string name = "logged report " + std::to_string(row);
  if (!found.step()) throw refined_damage(erosion_id, name + " is missing");
  if (found.integer(1) != refined_log_sum(erosion_id, found.integer(2), found.blob(0)))
    throw refined_damage(erosion_id, name + " does not match its checksum");
  return std::string(found.blob(0));
}

void visit_refined_log(Database& db, std::int64_t erosion_id, std::int64_t known, std::int64_t through,
                       const std::function<void(std::string_view)>& visit) {
  for (const std::int64_t row : refined_log_rows(db, erosion_id, known, through))
    visit(load_refined_log(db, erosion_id, row));
}

// The log of a round belongs to no chunk.
std::int64_t refined_log_sum(std::int64_t erosion_id, std::int64_t round, std::string_view records) {
  return checksum(erosion_id, -1 - round, records);
}

std::int64_t refined_log_bytes(Database& db, std::int64_t erosion_id) {
  return db.integer("SELECT sum(length(data)) FROM refined_log WHERE erosion_id = ?", erosion_id).value_or(0);
}

void merge_refined_log(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t through) {
  put_into_chunks(db, erosion_id, points, latest_of_log(db, erosion_id, through), false);
  db.run("DELETE FROM refined_log WHERE erosion_id = ? AND round <= ?", erosion_id, through);
}

RefinedView::RefinedView(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t through)
    : db_(db), erosion_id_(erosion_id), points_(points), log_(latest_of_log(db, erosion_id, through)) {}

std::int64_t RefinedView::chunk_count() const {
  return field_chunk_count(points_);
}

std::string RefinedView::chunk(std::int64_t index) const {
  std::string bytes = load_refined_chunk(db_, erosion_id_, index);
  if (bytes.empty()) throw refined_damage(erosion_id_, "chunk " + std::to_string(index) + " is missing");
  const auto of_chunk = [&](std::int64_t at) {
    return std::partition_point(log_.begin(), log_.end(), [&](const wire::RefinedPointRecord& record) {
      return record.point < at * kChunkPoints;
    });
  };
  put_into(bytes, index, of_chunk(index), of_chunk(index + 1));
  return bytes;
}

}  // namespace affskel::server

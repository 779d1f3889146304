#include "check/field_faults.h"

#include <bit>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "store/field.h"
#include "store/field_rows.h"
#include "wire/field_record.h"

namespace affskel::server {
namespace {

using OnFault = std::function<void(FieldFault)>;

bool natural(double value) {
  return std::isfinite(value) && value >= 0;
}

/// A value that a report may have brought: see RecordBatch.
template <typename Record>
bool reported(const Record& record, const FieldShape& field) {
  return record.direction < field.directions && natural(record.erosion) && natural(record.area);
}

/// A place that no report has reached.
bool empty(const wire::FieldRecord& record) {
  return record.direction == wire::kNoDirection && std::isinf(record.erosion) && record.erosion > 0 &&
         std::bit_cast<std::uint64_t>(record.area) == 0;
}

/// One fault for all bad points of a chunk; "" when there are none.
std::string bad_points(const FieldShape& field, std::int64_t index, std::string_view chunk) {
  std::size_t bad = 0, first = 0;
  const std::size_t points = chunk.size() / wire::kFieldRecordBytes;
  for (std::size_t i = 0; i < points; ++i) {
    const wire::FieldRecord record = wire::decode_field_record(chunk.data() + i * wire::kFieldRecordBytes);
    if (reported(record, field) || (!field.finished && empty(record))) continue;
    if (bad++ == 0) first = i;
  }
  if (bad == 0) return {};
  const std::int64_t point = index * kChunkPoints + static_cast<std::int64_t>(first);
  return std::to_string(bad) + " points without a value that a direction can give, the first is " +
         std::to_string(point);
}

/// "" for a sound one.
std::string fault_of_chunk(Database& db, const FieldShape& field, std::int64_t index,
                           std::string_view chunk) {
  const std::int64_t count = field_chunk_count(field.points);
  if (index >= count) return "the field ends before it, with " + std::to_string(count) + " chunks";
  if (chunk.size() != field_chunk_points(field.points, index) * wire::kFieldRecordBytes) {
    return "has " + std::to_string(chunk.size()) + " bytes, not those of its points";
  }
  if (!chunk_is_sound(db, field.erosion_id, index, chunk)) return "does not match its checksum";
  return bad_points(field, index, chunk);
}

void find_in_chunks(Database& db, const FieldShape& field, const OnFault& on_fault) {
  const std::string name = "erosion " + std::to_string(field.erosion_id);
  const std::int64_t count = field_chunk_count(field.points);
  std::int64_t found = 0;
  Statement row = db.query("SELECT idx, data, id FROM field_chunks WHERE erosion_id = ?", field.erosion_id);
  while (row.step()) {
    if (row.integer(0) < count) ++found;
    std::string what = fault_of_chunk(db, field, row.integer(0), row.blob(1));
    if (what.empty()) continue;
    on_fault({"field_chunks", row.integer(2), name + ", field chunk " + row.text(0), std::move(what)});
  }
  Statement lost = db.query(
      "SELECT idx FROM field_sums s WHERE erosion_id = ?1 AND NOT EXISTS"
      " (SELECT 1 FROM field_chunks WHERE erosion_id = ?1 AND idx = s.idx)",
      field.erosion_id);
  while (lost.step()) on_fault({nullptr, 0, name + ", field chunk " + lost.text(0), "is missing"});
  if (field.finished && found < count) {
    on_fault({nullptr, 0, name,
              "is finished, but only " + std::to_string(found) + " of " + std::to_string(count) +
                  " chunks of its field are there"});
  }
}

/// "" for sound ones.
std::string fault_of_log(const FieldShape& field, std::string_view bytes, std::int64_t sum,
                         const std::optional<std::int64_t>& part) {
  if (!log_is_sound(field.erosion_id, bytes, sum)) return "does not match its checksum";
  std::size_t bad = 0;
  for (std::size_t at = 0; at + wire::kPointRecordBytes <= bytes.size(); at += wire::kPointRecordBytes) {
    const wire::PointRecord record = wire::decode_point_record(bytes.data() + at);
    const bool elsewhere = part && record.point / kLogPartPoints != *part;
    if (record.point >= field.points || elsewhere || !reported(record, field)) ++bad;
  }
  return bad == 0 ? std::string() : std::to_string(bad) + " records that no report can have brought";
}

void find_in_log(Database& db, const FieldShape& field, const OnFault& on_fault) {
  Statement row =
      db.query("SELECT id, data, sum, part FROM field_log WHERE erosion_id = ?", field.erosion_id);
  while (row.step()) {
    std::string what = fault_of_log(field, row.blob(1), row.integer(2),
                                    row.is_null(3) ? std::nullopt : std::optional(row.integer(3)));
    if (what.empty()) continue;
    on_fault({"field_log", row.integer(0),
              "erosion " + std::to_string(field.erosion_id) + ", logged report " + row.text(0),
              std::move(what)});
  }
}

}  // namespace

void for_each_field(Database& db, const std::function<void(const FieldShape&)>& visit) {
  std::vector<FieldShape> fields;
  {
    Statement row = db.query(
        "SELECT id, points, directions, finished, directions_done FROM erosions"
        " WHERE dropped = 0 AND core_version IS NOT NULL ORDER BY id");
    while (row.step()) {
      Columns columns(row);
      FieldShape& field = fields.emplace_back();
      field.erosion_id = columns.integer();
      field.points = columns.integer();
      field.directions = columns.integer();
      field.finished = columns.flag();
      field.done = columns.integer();
    }
  }
  for (const FieldShape& field : fields) visit(field);
}

void find_field_faults(Database& db, const FieldShape& field,
                       const std::function<void(FieldFault)>& on_fault) {
  find_in_chunks(db, field, on_fault);
  find_in_log(db, field, on_fault);
}

}  // namespace affskel::server

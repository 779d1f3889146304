#include "check/check_contents.h"

#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <string_view>

#include "affskel/v1/types.pb.h"
#include "store/field.h"
#include "wire/limits.h"
#include "wire/sha256.h"

namespace affskel::server {
namespace {

std::string of(std::int64_t number, std::int64_t count) {
  return std::to_string(number) + " of " + std::to_string(count);
}

// Meshes and artefacts

/// What is recorded about bytes that lie in pieces.
struct Recorded {
  std::string where;
  std::int64_t bytes;
  std::string sha256;
};

/// @param piece rows of index and bytes, by index.
void check_pieces(Statement piece, const Recorded& recorded, FaultLog& faults) {
  wire::Sha256 hash;
  std::int64_t bytes = 0;
  for (std::int64_t index = 0; piece.step(); ++index) {
    if (piece.integer(0) != index) {
      return faults.add(recorded.where, "piece " + std::to_string(index) + " is missing");
    }
    hash.update(piece.blob(1));
    bytes += static_cast<std::int64_t>(piece.blob(1).size());
  }
  if (bytes != recorded.bytes) {
    return faults.add(recorded.where, "has " + std::to_string(bytes) + " bytes, recorded are " +
                                          std::to_string(recorded.bytes));
  }
  const std::string digest = hash.hex_digest();
  if (digest != recorded.sha256) {
    faults.add(recorded.where, "has the SHA-256 " + digest + ", recorded is " + recorded.sha256);
  }
}

void check_meshes(Database& db, FaultLog& faults) {
  Statement row =
      db.query("SELECT sha256, bytes FROM meshes WHERE sha256 NOT IN (SELECT sha256 FROM dropped_meshes)");
  while (row.step()) {
    check_pieces(db.query("SELECT idx, data FROM mesh_chunks WHERE sha256 = ? ORDER BY idx", row.text(0)),
                 {"mesh " + row.text(0), row.integer(1), row.text(0)}, faults);
  }
  faults.end_kind();
}

void check_artifacts(Database& db, FaultLog& faults) {
  Statement row = db.query(
      "SELECT a.id, a.kind, a.erosion_id, a.bytes, a.sha256 FROM artifacts a"
      " JOIN erosions e ON e.id = a.erosion_id WHERE e.dropped = 0");
  while (row.step()) {
    check_pieces(
        db.query("SELECT idx, data FROM artifact_chunks WHERE artifact_id = ? ORDER BY idx", row.integer(0)),
        {"artefact " + row.text(0) + " (" + row.text(1) + " of erosion " + row.text(2) + ")", row.integer(3),
         row.text(4)},
        faults);
  }
  faults.end_kind();
}

// Fields

struct FieldShape {
  std::int64_t erosion_id;
  std::int64_t points;
  std::int64_t directions;
  bool finished;
};

bool natural(double value) {
  return std::isfinite(value) && value >= 0;
}

/// A value that a report may have brought: see RecordBatch.
bool reported(const FieldRecord& record, const FieldShape& field) {
  return record.direction < field.directions && natural(record.erosion) && natural(record.area);
}

/// A place that no report has reached.
bool empty(const FieldRecord& record) {
  return record.direction == kNoDirection && std::isinf(record.erosion) && record.erosion > 0 &&
         std::bit_cast<std::uint64_t>(record.area) == 0;
}

FieldRecord record_at(std::string_view chunk, std::size_t index) {
  FieldRecord record{};
  const char* from = chunk.data() + index * wire::kFieldRecordBytes;
  std::memcpy(&record.erosion, from, sizeof record.erosion);
  std::memcpy(&record.area, from + 8, sizeof record.area);
  std::memcpy(&record.direction, from + 16, sizeof record.direction);
  return record;
}

/// One fault for all bad points of a chunk.
void check_chunk(const FieldShape& field, std::int64_t index, std::string_view chunk,
                 const std::string& where, FaultLog& faults) {
  std::size_t bad = 0, first = 0;
  const std::size_t points = chunk.size() / wire::kFieldRecordBytes;
  for (std::size_t i = 0; i < points; ++i) {
    const FieldRecord record = record_at(chunk, i);
    if (reported(record, field) || (!field.finished && empty(record))) continue;
    if (bad++ == 0) first = i;
  }
  if (bad == 0) return;
  const std::int64_t point = index * kChunkPoints + static_cast<std::int64_t>(first);
  faults.add(where, std::to_string(bad) + " points without a value that a direction can give, the first is " +
                        std::to_string(point));
}

void check_chunks(Database& db, const FieldShape& field, FaultLog& faults) {
  const std::string name = "erosion " + std::to_string(field.erosion_id);
  const std::int64_t count = field_chunk_count(field.points);
  std::int64_t found = 0;
  Statement row = db.query("SELECT idx, data FROM field_chunks WHERE erosion_id = ?", field.erosion_id);
  while (row.step()) {
    const std::int64_t index = row.integer(0);
    const std::string where = name + ", field chunk " + std::to_string(index);
    if (index < count) ++found;
    if (index >= count) {
      faults.add(where, "the field ends before it, with " + std::to_string(count) + " chunks");
    } else if (row.blob(1).size() != field_chunk_points(field.points, index) * wire::kFieldRecordBytes) {
      faults.add(where, "has " + std::to_string(row.blob(1).size()) + " bytes, not those of its points");
    } else {
      check_chunk(field, index, row.blob(1), where, faults);
    }
  }
  if (field.finished && found < count) {
    faults.add(name, "is finished, but only " + of(found, count) + " chunks of its field are there");
  }
}

void check_log(Database& db, const FieldShape& field, FaultLog& faults) {
  Statement row = db.query("SELECT id, data FROM field_log WHERE erosion_id = ?", field.erosion_id);
  while (row.step()) {
    const std::string_view bytes = row.blob(1);
    std::size_t bad = 0;
    for (std::size_t at = 0; at + sizeof(FieldRecord) <= bytes.size(); at += sizeof(FieldRecord)) {
      FieldRecord record{};
      std::memcpy(&record, bytes.data() + at, sizeof record);
      if (record.point >= field.points || !reported(record, field)) ++bad;
    }
    if (bad == 0) continue;
    faults.add("erosion " + std::to_string(field.erosion_id) + ", logged report " + row.text(0),
               std::to_string(bad) + " records that no report can have brought");
  }
}

void check_fields(Database& db, FaultLog& faults) {
  Statement row = db.query(
      "SELECT id, points, directions, finished FROM erosions WHERE dropped = 0 AND core_version IS NOT NULL");
  while (row.step()) {
    const FieldShape field{row.integer(0), row.integer(1), row.integer(2), row.flag(3)};
    check_chunks(db, field, faults);
    check_log(db, field, faults);
  }
  faults.end_kind();
}

// Messages

bool readable(google::protobuf::MessageLite&& message, std::string_view bytes) {
  return message.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()));
}

/// @param sql names where and gives the message.
template <typename Message>
void check_messages(Database& db, FaultLog& faults, const char* sql) {
  Statement row = db.query(sql);
  while (row.step()) {
    if (!readable(Message(), row.blob(1))) faults.add(row.text(0), "a stored message cannot be read");
  }
  faults.end_kind();
}

void check_all_messages(Database& db, FaultLog& faults) {
  check_messages<v1::ErosionParams>(db, faults,
                                    "SELECT 'erosion ' || id || ', parameters', params FROM erosions");
  check_messages<v1::SkeletonParams>(db, faults,
                                     "SELECT 'job ' || id || ', skeleton parameters', skeleton FROM jobs");
  check_messages<v1::SkeletonQuality>(
      db, faults, "SELECT 'job ' || id || ', quality', quality FROM jobs WHERE quality IS NOT NULL");
  check_messages<v1::SkeletonQuality>(
      db, faults,
      "SELECT 'artefact ' || id || ', quality', quality FROM artifacts WHERE quality IS NOT NULL");
  check_messages<v1::SkeletonParams>(
      db, faults,
      "SELECT 'task ' || id || ', parameters', params FROM tasks WHERE kind IN ('skeleton', 'divergence')");
  check_messages<v1::SurfaceParams>(
      db, faults, "SELECT 'task ' || id || ', parameters', params FROM tasks WHERE kind = 'surface'");
  check_messages<v1::ErodedParams>(db, faults,
                                   "SELECT 'task ' || id || ', parameters', params FROM tasks"
                                   " WHERE kind IN ('eroded-points', 'eroded-surface')");
}

/// The summary of the prepare stage against the columns that were taken from it.
void check_summaries(Database& db, FaultLog& faults) {
  Statement row = db.query(
      "SELECT 'erosion ' || id, prepared, points, directions, stride FROM erosions WHERE core_version IS NOT"
      " NULL");
  while (row.step()) {
    v1::PreparedSummary summary;
    const std::int64_t points = row.integer(2), directions = row.integer(3);
    if (!summary.ParseFromArray(row.blob(1).data(), static_cast<int>(row.blob(1).size()))) {
      faults.add(row.text(0) + ", summary", "a stored message cannot be read");
    } else if (summary.points() != static_cast<std::uint64_t>(points) ||
               summary.directions() != static_cast<std::uint64_t>(directions)) {
      faults.add(row.text(0), "has " + std::to_string(points) + " points and " + std::to_string(directions) +
                                  " directions, its summary says " + std::to_string(summary.points()) +
                                  " and " + std::to_string(summary.directions()));
    }
    // Otherwise the order of work would come to some directions twice and to others never.
    if (std::gcd(row.integer(4), directions) != 1) {
      faults.add(row.text(0), "the stride " + row.text(4) + " has a divisor in common with the " +
                                  std::to_string(directions) + " directions");
    }
  }
  faults.end_kind();
}

}  // namespace

void check_contents(Database& db, FaultLog& faults) {
  check_meshes(db, faults);
  check_artifacts(db, faults);
  check_fields(db, faults);
  check_all_messages(db, faults);
  check_summaries(db, faults);
}

}  // namespace affskel::server

#include "store/field.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "database/errors.h"
#include "store/field_rows.h"
#include "wire/field_record.h"

namespace affskel::server {
namespace {

using wire::PointRecord;

// A chunk is written back in stretches of this many points, and only those that changed: late in a job
// few points of a chunk still improve, and each page written costs its place in the log.
constexpr std::size_t kStretchPoints = 256;

// Logged records take at most so many times what their part of the field does: merging them rewrites all of it.
constexpr std::int64_t kMostLogged = 3;

// Of the volume, by which E may exceed it: E has 36 significant bits.
constexpr double kRoundedUp = 1 + 0x1p-30;

// A worker sends a point once per report and thread; anything above this is a bug or an attack.
constexpr std::int64_t kMaxRecordsPerPoint = 64;

[[noreturn]] void refuse_field(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, "report: " + why);
}

std::string empty_chunk(std::size_t count) {
  char record[wire::kFieldRecordBytes];
  wire::encode_field_record(record, {});
  std::string chunk;
  chunk.reserve(count * wire::kFieldRecordBytes);
  for (std::size_t i = 0; i < count; ++i) chunk.append(record, wire::kFieldRecordBytes);
  return chunk;
}

/// Replaces the record at `to` when (E, direction) of `record` is smaller.
bool merge_one(char* to, const PointRecord& record) {
  const wire::FieldRecord stored = wire::decode_field_record(to);
  if (record.erosion > stored.erosion) return false;
  if (record.erosion == stored.erosion && record.direction >= stored.direction) return false;
  wire::encode_field_record(to, {record.erosion, record.area, record.direction});
  return true;
}

using Records = std::vector<PointRecord>::const_iterator;

bool is_of_earlier_chunk(const PointRecord& a, const PointRecord& b) {
  return a.point / kChunkPoints < b.point / kChunkPoints;
}

// Counting sort: single reports arrive sorted, so this runs only when several come together.
void sort_by_chunk(std::vector<PointRecord>& records) {
  if (std::is_sorted(records.begin(), records.end(), is_of_earlier_chunk)) return;
  std::vector<std::size_t> place;  // of the next record of a chunk, once summed up
  for (const PointRecord& record : records) {
    const auto chunk = static_cast<std::size_t>(record.point / kChunkPoints);
    if (chunk + 2 > place.size()) place.resize(chunk + 2, 0);
    ++place[chunk + 1];
  }
  std::partial_sum(place.begin(), place.end(), place.begin());
  std::vector<PointRecord> sorted(records.size());
  for (const PointRecord& record : records) {
    sorted[place[static_cast<std::size_t>(record.point / kChunkPoints)]++] = record;
  }
  records.swap(sorted);
}

/// Whether the records, sorted by chunk, are at least every second point of the chunks that they touch.  Such
/// are written once when they are merged at once, and twice when they are logged first: a job's first
/// reports.
bool is_dense(Records begin, Records end) {
  std::ptrdiff_t chunks = 1;
  for (Records i = begin + 1; i < end; ++i) chunks += is_of_earlier_chunk(i[-1], *i) ? 1 : 0;
  return 2 * (end - begin) >= chunks * kChunkPoints;
}

std::int64_t log_part_of(std::int64_t point) {
  return point / kLogPartPoints;
}

std::int64_t chunk_row(Database& db, std::int64_t erosion_id, std::int64_t index) {
  return db.integer("SELECT id FROM field_chunks WHERE erosion_id = ? AND idx = ?", erosion_id, index)
      .value();
}

}  // namespace

RecordBatch::RecordBatch(std::int64_t points, std::int64_t directions, double volume, std::uint64_t expected)
    : points_(points), directions_(directions), most_(volume * kRoundedUp) {
  records_.reserve(std::min({expected, static_cast<std::uint64_t>(points), std::uint64_t{kMaxRecordsHeld}}));
}

void RecordBatch::append(const v1::FieldRecords& records) {
  const int count = records.point_size();
  if (records.direction_size() != count || records.erosion_size() != count || records.area_size() != count) {
    refuse_field("the four arrays of records differ in length");
  }
  if (cleared_ + static_cast<std::int64_t>(records_.size()) + count > kMaxRecordsPerPoint * points_) {
    refuse_field("more than " + std::to_string(kMaxRecordsPerPoint) + " records per point");
  }
  for (int i = 0; i < count; ++i) {
    PointRecord record{records.erosion(i), records.area(i), records.direction(i), records.point(i)};
    require_possible(record);
    record.area += 0.0;  // one zero only: equal values must be equal bytes, whatever the order of merging
    records_.push_back(record);
  }
}

void RecordBatch::require_possible(const PointRecord& record) const {
  if (record.point >= points_)
    refuse_field("point " + std::to_string(record.point) + " of " + std::to_string(points_));
  if (record.direction >= directions_) {
    refuse_field("direction " + std::to_string(record.direction) + " of " + std::to_string(directions_));
  }
  if (!(record.erosion > 0 && record.erosion <= most_)) {
    refuse_field("E of point " + std::to_string(record.point) + " is " + std::to_string(record.erosion) +
                 ": not above 0 and at most the volume of the solid");
  }
  if (!std::isfinite(record.area) || record.area < 0) {
    refuse_field("the area of point " + std::to_string(record.point) + " is negative or not finite");
  }
}

void RecordBatch::sort() {
  sort_by_chunk(records_);
}

void RecordBatch::clear() {
  cleared_ += static_cast<std::int64_t>(records_.size());
  records_ = {};  // many reports may wait for their next part
}

FieldPart::FieldPart(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t part)
    : db_(db), erosion_id_(erosion_id), points_(points), part_(part) {}

FieldPart::Chunk& FieldPart::chunk(std::int64_t index) {
  Chunk& chunk = chunks_[static_cast<std::size_t>(index % kLogPartChunks)];
  if (!chunk.bytes.empty()) return chunk;
  const std::size_t count = field_chunk_points(points_, index);
  chunk.bytes = load_chunk(db_, erosion_id_, index);
  chunk.is_stored = !chunk.bytes.empty();
  if (!chunk.is_stored) chunk.bytes = empty_chunk(count);
  chunk.changed.assign((count + kStretchPoints - 1) / kStretchPoints, false);
  return chunk;
}

void FieldPart::merge(const PointRecord& record) {
  Chunk& to = chunk(record.point / kChunkPoints);
  const std::size_t at = record.point % kChunkPoints;
  if (merge_one(to.bytes.data() + at * wire::kFieldRecordBytes, record))
    to.changed[at / kStretchPoints] = true;
}

void FieldPart::merge_log() {
  load_log(db_, erosion_id_, part_, [&](std::string_view bytes) {
    for (; !bytes.empty(); bytes.remove_prefix(wire::kPointRecordBytes)) {
      const PointRecord record = wire::decode_point_record(bytes.data());
      if (log_part_of(record.point) == part_) merge(record);
    }
  });
}

void FieldPart::store() {
  for (std::int64_t i = 0; i < kLogPartChunks; ++i) {
    const Chunk& chunk = chunks_[static_cast<std::size_t>(i)];
    if (std::find(chunk.changed.begin(), chunk.changed.end(), true) == chunk.changed.end()) continue;
    const std::int64_t index = part_ * kLogPartChunks + i;
    if (chunk.is_stored) {
      write_changed(index, chunk);
    } else {
      insert_chunk(db_, erosion_id_, index, chunk.bytes);
    }
  }
}

void FieldPart::write_changed(std::int64_t index, const Chunk& chunk) {
  BlobHandle blob(db_, "field_chunks", "data", chunk_row(db_, erosion_id_, index));
  const std::size_t stretch_bytes = kStretchPoints * wire::kFieldRecordBytes;
  for (std::size_t first = 0; first < chunk.changed.size(); ++first) {
    if (!chunk.changed[first]) continue;
    std::size_t last = first;
    while (last + 1 < chunk.changed.size() && chunk.changed[last + 1]) ++last;
    const std::size_t begin = first * stretch_bytes;
    const std::size_t end = std::min(chunk.bytes.size(), (last + 1) * stretch_bytes);
    blob.write(chunk.bytes.data() + begin, static_cast<int>(end - begin), static_cast<int>(begin));
    first = last;
  }
  sign_chunk(db_, erosion_id_, index, chunk.bytes);
}

namespace {

std::string log_bytes(Records begin, Records end) {
  std::string bytes(static_cast<std::size_t>(end - begin) * wire::kPointRecordBytes, '\0');
  char* to = bytes.data();
  for (; begin != end; ++begin, to += wire::kPointRecordBytes) wire::encode_point_record(to, *begin);
  return bytes;
}

enum class Logged { kMerged, kLeft };

/// Merges [begin, end) of a part, and perhaps what is logged of it, into its chunks.  What an earlier server logged
/// stays until the field is settled.
void merge_part(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t part, Logged logged,
                Records begin, Records end) {
  FieldPart chunks(db, erosion_id, points, part);
  if (logged == Logged::kMerged) chunks.merge_log();
  std::for_each(begin, end, [&](const PointRecord& record) { chunks.merge(record); });
  chunks.store();
  if (logged == Logged::kMerged)
    db.run("DELETE FROM field_log WHERE erosion_id = ? AND part = ?", erosion_id, part);
}

}  // namespace

void merge_records(Database& db, std::int64_t erosion_id, std::int64_t points,
                   const std::vector<PointRecord>& records) {
  for (Records begin = records.begin(); begin != records.end();) {
    const std::int64_t part = log_part_of(begin->point);
    const Records end = std::find_if(begin, records.end(),
                                     [&](const PointRecord& r) { return log_part_of(r.point) != part; });
    const std::int64_t most = kMostLogged * static_cast<std::int64_t>(wire::kFieldRecordBytes) *
                              std::min(kLogPartPoints, points - part * kLogPartPoints);
    if (is_dense(begin, end)) {
      merge_part(db, erosion_id, points, part, Logged::kLeft, begin, end);
    } else if (const std::string bytes = log_bytes(begin, end);
               logged_bytes(db, erosion_id, part) + static_cast<std::int64_t>(bytes.size()) <= most) {
      insert_log(db, erosion_id, part, bytes);
    } else {
      merge_part(db, erosion_id, points, part, Logged::kMerged, begin, end);
    }
    begin = end;
  }
}

void settle_field(Database& db, std::int64_t erosion_id, std::int64_t points) {
  for (std::int64_t part = 0; part * kLogPartPoints < points; ++part)
    merge_part(db, erosion_id, points, part, Logged::kMerged, {}, {});
  db.run("DELETE FROM field_log WHERE erosion_id = ?", erosion_id);
}

std::int64_t remove_values(Database& db, std::int64_t erosion_id, std::int64_t points,
                           const std::function<bool(std::uint32_t direction)>& gone) {
  settle_field(db, erosion_id, points);
  char none[wire::kFieldRecordBytes];
  wire::encode_field_record(none, {});
  std::int64_t removed = 0;
  for (std::int64_t index = 0; index < field_chunk_count(points); ++index) {
    std::string chunk = load_chunk(db, erosion_id, index);
    const std::int64_t before = removed;
    for (std::size_t at = 0; at < chunk.size(); at += wire::kFieldRecordBytes) {
      const wire::FieldRecord record = wire::decode_field_record(chunk.data() + at);
      if (record.direction == wire::kNoDirection || !gone(record.direction)) continue;
      chunk.replace(at, wire::kFieldRecordBytes, none, wire::kFieldRecordBytes);
      ++removed;
    }
    if (removed == before) continue;
    db.run("UPDATE field_chunks SET data = ? WHERE erosion_id = ? AND idx = ?", Blob{chunk}, erosion_id,
           index);
    sign_chunk(db, erosion_id, index, chunk);
  }
  return removed;
}

std::int64_t field_chunk_count(std::int64_t points) {
  return (points + kChunkPoints - 1) / kChunkPoints;
}

std::size_t field_chunk_points(std::int64_t points, std::int64_t index) {
  return static_cast<std::size_t>(std::min(kChunkPoints, points - index * kChunkPoints));
}

FieldView::FieldView(Database& db, std::int64_t erosion_id, std::int64_t points)
    : db_(db), erosion_id_(erosion_id), points_(points) {}

std::string FieldView::chunk(std::int64_t index) {
  const std::int64_t part = index / kLogPartChunks;
  if (!part_ || part_->number() != part || index < next_)
    part_.emplace(db_, erosion_id_, points_, part).merge_log();
  next_ = index + 1;
  return part_->take_bytes(index);
}

}  // namespace affskel::server

#include "store/field.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "database/errors.h"
#include "store/field_rows.h"
#include "wire/field_record.h"

namespace affskel::server {
namespace {

using wire::PointRecord;

constexpr std::size_t kRecordBytes = wire::kFieldRecordBytes;

// A chunk is written back in stretches of this many points, and only those that changed: late in a job
// few points of a chunk still improve, and each page written costs its place in the log.
constexpr std::size_t kStretchPoints = 256;

// Logged records take at most so many times what their part of the field does: merging them rewrites all of it.
constexpr std::int64_t kMostLogged = 2;

// Of the volume, by which E may exceed it: E has 36 significant bits.
constexpr double kRoundedUp = 1 + 0x1p-30;

// A worker sends a point once per report and thread; anything above this is a bug or an attack.
constexpr std::int64_t kMaxRecordsPerPoint = 64;

[[noreturn]] void refuse_field(const std::string& why) {
  throw StoreError(StoreError::Code::kInvalid, "report: " + why);
}

std::string empty_chunk(std::size_t count) {
  char record[kRecordBytes];
  wire::encode_field_record(record, {});
  std::string chunk;
  chunk.reserve(count * kRecordBytes);
  for (std::size_t i = 0; i < count; ++i) chunk.append(record, kRecordBytes);
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

/// Merges [begin, end), all of chunk `index`; marks the stretches that changed.
std::vector<bool> merge_into(std::string& chunk, std::int64_t index, Records begin, Records end) {
  const std::size_t count = chunk.size() / kRecordBytes;
  std::vector<bool> changed((count + kStretchPoints - 1) / kStretchPoints);
  for (Records record = begin; record != end; ++record) {
    const std::size_t at = record->point - static_cast<std::size_t>(index * kChunkPoints);
    if (merge_one(chunk.data() + at * kRecordBytes, *record)) changed[at / kStretchPoints] = true;
  }
  return changed;
}

/// Whether there was any.
bool write_changed(BlobHandle& blob, const std::string& chunk, const std::vector<bool>& changed) {
  bool written = false;
  const std::size_t stretch_bytes = kStretchPoints * kRecordBytes;
  for (std::size_t first = 0; first < changed.size(); ++first) {
    if (!changed[first]) continue;
    std::size_t last = first;
    while (last + 1 < changed.size() && changed[last + 1]) ++last;
    const std::size_t begin = first * stretch_bytes;
    const std::size_t end = std::min(chunk.size(), (last + 1) * stretch_bytes);
    blob.write(chunk.data() + begin, static_cast<int>(end - begin), static_cast<int>(begin));
    written = true;
    first = last;
  }
  return written;
}

struct ByChunk {
  bool operator()(const PointRecord& a, const PointRecord& b) const {
    return a.point / kChunkPoints < b.point / kChunkPoints;
  }
  bool operator()(const PointRecord& a, std::int64_t index) const { return a.point / kChunkPoints < index; }
  bool operator()(std::int64_t index, const PointRecord& a) const { return index < a.point / kChunkPoints; }
};

// Counting sort: single reports arrive sorted, so this runs only when several come together.
void sort_by_chunk(std::vector<PointRecord>& records) {
  if (std::is_sorted(records.begin(), records.end(), ByChunk{})) return;
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
  for (Records i = begin + 1; i < end; ++i) chunks += ByChunk{}(i[-1], *i) ? 1 : 0;
  return 2 * (end - begin) >= chunks * kChunkPoints;
}

std::int64_t log_part_of(std::int64_t point) {
  return point / kLogPartPoints;
}

std::optional<std::int64_t> chunk_row(Database& db, std::int64_t erosion_id, std::int64_t index) {
  return db.integer("SELECT id FROM field_chunks WHERE erosion_id = ? AND idx = ?", erosion_id, index);
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
    record.area += 0.0;  // one zero only: equal values must be equal bytes, whatever the order of merging
    records_.push_back(record);
  }
}

void RecordBatch::sort() {
  sort_by_chunk(records_);
}

void RecordBatch::clear() {
  cleared_ += static_cast<std::int64_t>(records_.size());
  records_ = {};  // many reports may wait for their next part
}

namespace {

/// Merges [begin, last), sorted by chunk.
void merge_into_chunks(Database& db, std::int64_t erosion_id, std::int64_t points, Records begin,
                       Records last) {
  std::optional<BlobHandle> blob;
  std::string chunk;
  while (begin != last) {
    const std::int64_t index = begin->point / kChunkPoints;
    const auto end =
        std::find_if(begin, last, [&](const PointRecord& r) { return r.point / kChunkPoints != index; });
    if (const std::optional<std::int64_t> row = chunk_row(db, erosion_id, index)) {
      if (blob) {
        blob->reopen(*row);
      } else {
        blob.emplace(db, "field_chunks", "data", *row);
      }
      chunk.resize(static_cast<std::size_t>(blob->size()));
      blob->read(chunk.data(), blob->size(), 0);
      require_sound_chunk(db, erosion_id, index, chunk);
      if (write_changed(*blob, chunk, merge_into(chunk, index, begin, end))) {
        sign_chunk(db, erosion_id, index, chunk);
      }
    } else {
      // An INSERT would make the open handle stale.
      blob.reset();
      chunk = empty_chunk(field_chunk_points(points, index));
      merge_into(chunk, index, begin, end);
      insert_chunk(db, erosion_id, index, chunk);
    }
    begin = end;
  }
}

// What is logged of a part of the field.
std::vector<PointRecord> read_log(Database& db, std::int64_t erosion_id, std::int64_t part) {
  std::vector<PointRecord> log;
  load_log(db, erosion_id, part, [&](std::string_view bytes) {
    for (; !bytes.empty(); bytes.remove_prefix(wire::kPointRecordBytes)) {
      const PointRecord record = wire::decode_point_record(bytes.data());
      if (log_part_of(record.point) == part) log.push_back(record);
    }
  });
  return log;
}

std::string log_bytes(Records begin, Records end) {
  std::string bytes(static_cast<std::size_t>(end - begin) * wire::kPointRecordBytes, '\0');
  char* to = bytes.data();
  for (; begin != end; ++begin, to += wire::kPointRecordBytes) wire::encode_point_record(to, *begin);
  return bytes;
}

/// Merges what is logged of a part, and [begin, end) of the same, into its chunks.  What an earlier server logged stays
/// until the field is settled.
void merge_part(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t part, Records begin,
                Records end) {
  std::vector<PointRecord> all = read_log(db, erosion_id, part);
  all.insert(all.end(), begin, end);
  sort_by_chunk(all);
  merge_into_chunks(db, erosion_id, points, all.begin(), all.end());
  db.run("DELETE FROM field_log WHERE erosion_id = ? AND part = ?", erosion_id, part);
}

}  // namespace

void merge_records(Database& db, std::int64_t erosion_id, std::int64_t points,
                   const std::vector<PointRecord>& records) {
  for (Records begin = records.begin(); begin != records.end();) {
    const std::int64_t part = log_part_of(begin->point);
    const Records end = std::find_if(begin, records.end(),
                                     [&](const PointRecord& r) { return log_part_of(r.point) != part; });
    const std::int64_t most = kMostLogged * static_cast<std::int64_t>(kRecordBytes) *
                              std::min(kLogPartPoints, points - part * kLogPartPoints);
    if (is_dense(begin, end)) {
      merge_into_chunks(db, erosion_id, points, begin, end);
    } else if (const std::string bytes = log_bytes(begin, end);
               logged_bytes(db, erosion_id, part) + static_cast<std::int64_t>(bytes.size()) <= most) {
      insert_log(db, erosion_id, part, bytes);
    } else {
      merge_part(db, erosion_id, points, part, begin, end);
    }
    begin = end;
  }
}

void settle_field(Database& db, std::int64_t erosion_id, std::int64_t points) {
  for (std::int64_t part = 0; part * kLogPartPoints < points; ++part)
    merge_part(db, erosion_id, points, part, {}, {});
  db.run("DELETE FROM field_log WHERE erosion_id = ?", erosion_id);
}

std::int64_t remove_values(Database& db, std::int64_t erosion_id, std::int64_t points,
                           const std::function<bool(std::uint32_t direction)>& gone) {
  settle_field(db, erosion_id, points);
  char none[kRecordBytes];
  wire::encode_field_record(none, {});
  std::int64_t removed = 0;
  for (std::int64_t index = 0; index < field_chunk_count(points); ++index) {
    std::string chunk = load_chunk(db, erosion_id, index);
    const std::int64_t before = removed;
    for (std::size_t at = 0; at < chunk.size(); at += kRecordBytes) {
      const wire::FieldRecord record = wire::decode_field_record(chunk.data() + at);
      if (record.direction == wire::kNoDirection || !gone(record.direction)) continue;
      chunk.replace(at, kRecordBytes, none, kRecordBytes);
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
  if (const std::int64_t part = log_part_of(index * kChunkPoints); part != part_) {
    log_ = read_log(db_, erosion_id_, part);
    sort_by_chunk(log_);
    part_ = part;
  }
  std::string bytes = load_chunk(db_, erosion_id_, index);
  if (bytes.empty()) bytes = empty_chunk(field_chunk_points(points_, index));
  const auto [begin, end] = std::equal_range(log_.begin(), log_.end(), index, ByChunk{});
  merge_into(bytes, index, begin, end);
  return bytes;
}

}  // namespace affskel::server

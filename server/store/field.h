#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "database/sqlite.h"
#include "wire/field_record.h"

namespace affskel::server {

/// Points per stored chunk of a field.
inline constexpr std::int64_t kChunkPoints = 4096;

/// So many chunks have a part of the log: they are what a reader has in memory of it, 2.5 MiB.
inline constexpr std::int64_t kLogPartChunks = 32;
inline constexpr std::int64_t kLogPartPoints = kLogPartChunks * kChunkPoints;

/// Records of a report that are held before they are merged: 3 MiB.  A report may bring any number of them.
inline constexpr std::size_t kMaxRecordsHeld = std::size_t{1} << 17;

/// Improved records of a report, or of a part of it, checked on the way in.
class RecordBatch {
 public:
  /// @param points, directions bounds of the job: R and K.
  /// @param volume of its solid, mesh units cubed: no chord is larger.
  /// @param expected number of records to make room for, as far as that is likely; there may be others.
  RecordBatch(std::int64_t points, std::int64_t directions, double volume, std::uint64_t expected = 0);

  /// @throws StoreError kInvalid when arrays differ in length, a point or direction is out of bounds, E is
  ///   not above 0 and at most the volume, the area is negative or not finite, or there are more records than a
  ///   report can need.
  void append(const v1::FieldRecords& records);

  /// Groups the records by chunk.
  void sort();

  /// Whether so much has come together that it should be merged before there is more.
  bool full() const { return records_.size() >= kMaxRecordsHeld; }

  /// Forgets the records; they still count towards what one report may bring.
  void clear();

  const std::vector<wire::PointRecord>& records() const { return records_; }

 private:
  void require_possible(const wire::PointRecord& record) const;

  std::int64_t points_;
  std::int64_t directions_;
  double most_;  // E
  std::int64_t cleared_ = 0;
  std::vector<wire::PointRecord> records_;
};

/// Merges records, sorted by chunk, into the field of `points` points: per point the lexicographic minimum of
/// (E, direction), the area travelling with it.  Scattered records are only logged; dense ones, or a part of the
/// log grown long, are merged into the stored chunks, of which only what they touch is loaded and rewritten.
void merge_records(Database& db, std::int64_t erosion_id, std::int64_t points,
                   const std::vector<wire::PointRecord>& records);

/// Takes the values out of a field that `gone(direction)` is true of: their points count as not reached yet.
/// Returns how many there were.
std::int64_t remove_values(Database& db, std::int64_t erosion_id, std::int64_t points,
                           const std::function<bool(std::uint32_t direction)>& gone);

/// Merges what is logged into the chunks: for fields that are finished.
void settle_field(Database& db, std::int64_t erosion_id, std::int64_t points);

/// Number of chunks of a field.
std::int64_t field_chunk_count(std::int64_t points);

/// Points of one of its chunks.
std::size_t field_chunk_points(std::int64_t points, std::int64_t index);

/// The chunks of a part of the field's log, loaded when they are asked for or a record of theirs is merged.
class FieldPart {
 public:
  FieldPart(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t part);

  std::int64_t number() const { return part_; }

  /// In memory; of this part.
  void merge(const wire::PointRecord& record);
  void merge_log();

  /// Bytes of chunk `index` of the field, empty records where no report has been, which are not kept.
  std::string take_bytes(std::int64_t index) { return std::move(chunk(index).bytes); }

  /// Writes what was changed.
  void store();

 private:
  struct Chunk {
    std::string bytes;  // empty: not loaded yet
    bool is_stored = false;
    std::vector<bool> changed;  // by stretches
  };

  Chunk& chunk(std::int64_t index);
  void write_changed(std::int64_t index, const Chunk& chunk);

  Database& db_;
  std::int64_t erosion_id_;
  std::int64_t points_;
  std::int64_t part_;
  std::array<Chunk, kLogPartChunks> chunks_;
};

/// A field as it is in the database's transaction, the log included.
class FieldView {
 public:
  FieldView(Database& db, std::int64_t erosion_id, std::int64_t points);

  std::int64_t chunk_count() const { return field_chunk_count(points_); }

  /// Bytes of chunk `index`, empty records where no report has been.  In ascending order: each part of the log is then
  /// read once.
  std::string chunk(std::int64_t index);

 private:
  Database& db_;
  std::int64_t erosion_id_;
  std::int64_t points_;
  std::optional<FieldPart> part_;
  std::int64_t next_ = 0;  // chunk that was not asked for yet
};

}  // namespace affskel::server

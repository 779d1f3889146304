#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "affskel/v1/types.pb.h"
#include "store/sqlite.h"

namespace affskel::server {

/// Points per stored chunk of a field.
inline constexpr std::int64_t kChunkPoints = 4096;

/// Direction of a point that no direction has reached yet; its E is +infinity, its area 0.
inline constexpr std::uint32_t kNoDirection = 0xFFFFFFFF;

struct FieldRecord {
  double erosion;
  double area;
  std::uint32_t direction;
  std::uint32_t point;
};

/// Improved records of one report, checked on the way in.
class RecordBatch {
 public:
  /// @param points, directions bounds of the job: R and K.
  RecordBatch(std::int64_t points, std::int64_t directions);

  /// @throws StoreError kInvalid when arrays differ in length, a point or direction is out of bounds, E or
  ///   the area is negative or not finite, or there are more records than a report can need.
  void append(const v1::FieldRecords& records);

  /// Groups the records by chunk.
  void sort();

  const std::vector<FieldRecord>& records() const { return records_; }

 private:
  std::int64_t points_;
  std::int64_t directions_;
  std::vector<FieldRecord> records_;
};

/// Merges records, sorted by chunk, into the stored field of `points` points: per point the lexicographic
/// minimum of (E, direction), the area travelling with it.  Loads and rewrites only what it touches.
void merge_records(Database& db, std::int64_t erosion_id, std::int64_t points,
                   const std::vector<FieldRecord>& records);

/// Number of chunks of a field.
std::int64_t field_chunk_count(std::int64_t points);

/// Bytes of chunk `index`, empty records where no report has been.
std::string read_field_chunk(Database& db, std::int64_t erosion_id, std::int64_t points, std::int64_t index);

}  // namespace affskel::server

#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/coding.h"

namespace affskel::wire {

/// Direction of a point that no direction has reached yet; its E is +infinity, its area 0.
inline constexpr std::uint32_t kNoDirection = 0xFFFFFFFF;

/// What a field says of one sample point.
struct FieldRecord {
  double erosion = std::numeric_limits<double>::infinity();  ///< E, mesh units cubed
  double area = 0;                                           ///< of the section, mesh units squared
  std::uint32_t direction = kNoDirection;                    ///< index of the optimal direction
};

/// A stored or sent field (ARTIFACT_KIND_FIELD): for each sample point, in lattice order, E and area as
/// float64, the direction as uint32, least significant byte first.
inline constexpr std::size_t kFieldRecordBytes = 20;

/// Puts the record's kFieldRecordBytes bytes at `to`.
inline void encode_field_record(char* to, const FieldRecord& record) {
  base::encode(to, record.erosion);
  base::encode(to + 8, record.area);
  base::encode(to + 16, record.direction);
}

/// The record whose bytes are at `from`.
inline FieldRecord decode_field_record(const char* from) {
  return {base::decode<double>(from), base::decode<double>(from + 8), base::decode<std::uint32_t>(from + 16)};
}

/// The record of a point that is named: in reports, and in the server's log of them.
struct PointRecord {
  double erosion = std::numeric_limits<double>::infinity();
  double area = 0;
  std::uint32_t direction = kNoDirection;
  std::uint32_t point = 0;  ///< rank of the sample point
};

/// As a record of a field, then the point as uint32.
inline constexpr std::size_t kPointRecordBytes = 24;

inline void encode_point_record(char* to, const PointRecord& record) {
  encode_field_record(to, {record.erosion, record.area, record.direction});
  base::encode(to + kFieldRecordBytes, record.point);
}

inline PointRecord decode_point_record(const char* from) {
  const FieldRecord record = decode_field_record(from);
  return {record.erosion, record.area, record.direction,
          base::decode<std::uint32_t>(from + kFieldRecordBytes)};
}

}  // namespace affskel::wire

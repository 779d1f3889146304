#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "base/coding.h"

namespace affskel::wire {

/// No vertex.
inline constexpr std::uint32_t kNoSaddle = 0xFFFFFFFF;

/// What a refined field says of one sample point; with the default values, of one that no round has reached.
struct RefinedRecord {
  double erosion = std::numeric_limits<double>::infinity();  ///< E, mesh units cubed
  double slope = 0;                                          ///< |grad E|, mesh units squared
  std::array<double, 3> normal{};                            ///< of the least plane, unit
  std::array<std::uint32_t, 2> saddles{kNoSaddle, kNoSaddle};
  std::uint32_t round = 0;  ///< that found it
};

/// A stored or sent refined field (ARTIFACT_KIND_REFINED): for each sample point, in lattice order, these values one
/// after the other, least significant byte first.
inline constexpr std::size_t kRefinedRecordBytes = 52;

/// Puts the record's kRefinedRecordBytes bytes at `to`.
inline void encode_refined_record(char* to, const RefinedRecord& record) {
  base::encode(to, record.erosion);
  base::encode(to + 8, record.slope);
  for (std::size_t axis = 0; axis < 3; ++axis) base::encode(to + 16 + 8 * axis, record.normal[axis]);
  for (std::size_t n = 0; n < 2; ++n) base::encode(to + 40 + 4 * n, record.saddles[n]);
  base::encode(to + 48, record.round);
}

/// The record whose bytes are at `from`.
inline RefinedRecord decode_refined_record(const char* from) {
  RefinedRecord record;
  record.erosion = base::decode<double>(from);
  record.slope = base::decode<double>(from + 8);
  for (std::size_t axis = 0; axis < 3; ++axis)
    record.normal[axis] = base::decode<double>(from + 16 + 8 * axis);
  for (std::size_t n = 0; n < 2; ++n) record.saddles[n] = base::decode<std::uint32_t>(from + 40 + 4 * n);
  record.round = base::decode<std::uint32_t>(from + 48);
  return record;
}

/// The record of a point that is named: the point as uint32, then the record.
struct RefinedPointRecord {
  std::uint32_t point = 0;
  RefinedRecord record;
};

inline constexpr std::size_t kRefinedPointRecordBytes = 4 + kRefinedRecordBytes;

inline void encode_refined_point_record(char* to, const RefinedPointRecord& record) {
  base::encode(to, record.point);
  encode_refined_record(to + 4, record.record);
}

inline RefinedPointRecord decode_refined_point_record(const char* from) {
  return {base::decode<std::uint32_t>(from), decode_refined_record(from + 4)};
}

}  // namespace affskel::wire

#pragma once

#include <cstdint>

#include "affskel/v1/types.pb.h"

namespace affskel::wire {

// What a job takes in a worker, bytes; measured, see worker/core/README.md, limits.
inline constexpr std::uint64_t kBytesPerTriangle = 235;
inline constexpr std::uint64_t kBytesPerPoint = 52;
/// These beside the others while E is refined.
inline constexpr std::uint64_t kRefineBytesPerTriangle = 200;
inline constexpr std::uint64_t kRefineBytesPerPoint = 280;

/// What a skeleton takes at its peak, beside field and lattice, bytes per point: of a thin plate, where a sheet is
/// largest.
std::uint64_t skeleton_bytes_per_point(v1::Operator which);

}  // namespace affskel::wire

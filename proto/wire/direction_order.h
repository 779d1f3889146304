#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace affskel::wire {

/// Directions are worked on in the order p -> (p * stride) mod count, p = 0, 1, ...: a Kronecker
/// sequence, so that any stretch of positions holds directions from all over the set and the erosion
/// bounds tighten early.  Returns the number coprime to `count` nearest to count / golden ratio;
/// 1 for count <= 2.  A pure function of `count`, so that server, workers and clients agree.
std::uint64_t direction_stride(std::uint64_t count);

/// The direction at position p.  Requires p < count < 2^32.
inline std::uint64_t direction_at(std::uint64_t position, std::uint64_t stride, std::uint64_t count) {
  return position * stride % count;
}

/// All directions in that order.
std::vector<std::uint32_t> directions_in_order(std::size_t count);

}  // namespace affskel::wire

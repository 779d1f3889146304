#pragma once

#include <bit>
#include <cstdint>

namespace affskel::wire {

/// Bounds of E travel as the upper half of a float64: 20 bits of mantissa are as good for leaving points out
/// as 52, and every E fits, however large or small the mesh.  Least such bound of `erosion`, >= 0 and finite.
inline std::uint32_t bound_above(double erosion) {
  return static_cast<std::uint32_t>((std::bit_cast<std::uint64_t>(erosion) + 0xFFFFFFFFU) >> 32);
}

/// The bound's value; +infinity near the end of the range.
inline double bound_value(std::uint32_t bound) {
  return std::bit_cast<double>(std::uint64_t{bound} << 32);
}

}  // namespace affskel::wire

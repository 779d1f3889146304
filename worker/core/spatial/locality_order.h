#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

/// The indices of points along a Z-order curve through their bounding box (Morton 1966), 2^21 cells a side,
/// so that near points get near places; points of one cell by index.  For data that is looked up together
/// and would otherwise lie all over the memory.  O(n log n).
/// @param points finite.
std::vector<std::uint32_t> locality_order(const std::vector<Vec3>& points);

}  // namespace affskel::core

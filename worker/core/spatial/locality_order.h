#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

/// The indices of points along a Z-order curve through their bounding box (Morton 1966), 2^21 cells a side,
/// points of one cell by index: near points get near indices.  For data that are looked up together.
/// @param points finite.  O(n log n) for n points.
std::vector<std::uint32_t> locality_order(const std::vector<Vec3>& points);

}  // namespace affskel::core

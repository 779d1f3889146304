#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Chains segments into polylines: a point with two segments lies within one, any other ends those that meet
/// there.  A closed polyline begins and ends at its least point.  Each segment is in one of them, once.
/// @param points how many there are; every segment has two of them, different.
/// @return by the first segment of each, in their order.  O(points + segments).
std::vector<std::vector<std::uint32_t>> polylines(std::size_t points, std::span<const Segment> segments);

}  // namespace affskel::core

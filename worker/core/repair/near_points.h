#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Of the box's diagonal: what lies so near to each other may be parted by rounding.
inline constexpr double kNearOfDiagonal = 1e-6;

/// Joins ends of open edges that lie within a millionth of the box's diagonal of each other, and within a hundredth of
/// every open edge that ends at either: corners of one vertex that rounding has parted.  The first of them stands for
/// all; points do not move.
/// @return how many points were joined to another, which no triangle names any more.
std::uint64_t join_near_points(const std::vector<Vec3>& points, std::vector<Triangle>& triangles);

}  // namespace affskel::core

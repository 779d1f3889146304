#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Flips diagonals of quadrilaterals that are also edges of other faces, so that the polygons of a closed
/// surface stay closed when each was cut on its own.  Each such quadrilateral, in their order, takes its
/// other diagonal unless another face has that, too; all other triangles stay as they are.  O(n log n) for n
/// triangles.
/// @param quads per quadrilateral the index of the first of its two triangles, which are neighbours in
///   `triangles`.
/// @return the number of flipped diagonals.
std::size_t turn_doubled_diagonals(std::span<const std::uint32_t> quads, std::vector<Triangle>& triangles);

}  // namespace affskel::core

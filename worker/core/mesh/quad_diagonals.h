#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {

/// Turns the diagonals of quadrilaterals that are edges of other faces, too.  Cut one by one, two
/// quadrilaterals over the same two edges may both be cut along the line between the edges' ends, and so hold
/// one triangle twice; or a diagonal may be the edge of two triangles elsewhere.  The surface then seems not
/// to bound a solid, though its polygons do.  Each such quadrilateral, in their order, takes its other
/// diagonal if nothing else has it; all other triangles stay as they are.  O(n log n) for n triangles.
/// @param quads indices of the first of the two triangles, neighbours in `triangles`, of every quadrilateral.
/// @return how many were turned.
std::size_t turn_doubled_diagonals(std::span<const std::uint32_t> quads, std::vector<Triangle>& triangles);

}  // namespace affskel::core

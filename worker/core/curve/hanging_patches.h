#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/contour/sheet_mesh.h"

namespace affskel::core {

/// A surface of a skeleton that hangs on the rest by one line: a flat limb, such as an ear.
struct HangingPatch {
  std::uint32_t end = 0;  ///< the vertex that is farthest along the surface from where the line meets it
  double width = 0;       ///< half the limb's
};

/// The surfaces without tunnels that exactly one segment of the sheet leads to, and that have no end already.  Half the
/// width of such a limb is the greatest distance from a rim, along the surface, and that vertex's ball beside it.
/// O(N log N).
/// @param ball per vertex: distance to the surface of the solid.
/// @param has_end per vertex: not 0 where a limb ends.
/// @return by the least number of their vertices.
std::vector<HangingPatch> hanging_patches(const SheetMesh& sheet, std::span<const double> ball,
                                          std::span<const char> has_end);

}  // namespace affskel::core

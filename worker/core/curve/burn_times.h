#pragma once

#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/curve/sheet_edges.h"

namespace affskel::core {

/// When a fire that is lit at all rims of a sheet at once, and goes along it at unit speed, comes to the corners of its
/// triangles (the burn time of Yan, Sykes, Chambers, Letscher and Ju, "Erosion thickness on medial axes of 3D shapes", 2016).
/// Where sheets meet it goes on from the others into the last one, once they burn there: the rim of a fin is none of the
/// sheet that it stands on.  Ways go from vertex to vertex along triangles and pairs of them, and so are up to 8 % long.
/// Few triangles should meet at an edge or a vertex, as of lattices: it takes the square of their number.
/// @param left per triangle: whether it is there.
/// @return per triangle, three each: of its corners, in the sheet's unit of length; infinity where no fire comes, as on a
///   closed surface, and of triangles that are not there.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<double> burn_times(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left,
                               ExecutionContext* context = nullptr);

}  // namespace affskel::core

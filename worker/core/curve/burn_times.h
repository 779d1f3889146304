#pragma once

#include <span>
#include <vector>

#include "core/curve/sheet_edges.h"

namespace affskel::core {

/// When a fire that is lit at all rims of a sheet at once, and goes along it at unit speed, has burned each of its vertices
/// (the burn time of Yan, Sykes, Chambers, Letscher and Ju, "Erosion thickness on medial axes of 3D shapes", 2016).  Where
/// sheets meet it goes on from the others into the last one: the rim of a fin is none of the sheet that it stands on.
/// @param left per triangle: whether it is there.
/// @return per vertex; infinity where no fire comes, as on a closed surface, and 0 where no triangle is.
std::vector<double> burn_times(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left);

}  // namespace affskel::core

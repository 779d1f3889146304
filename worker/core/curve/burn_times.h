#pragma once

#include <span>
#include <vector>

#include "core/curve/sheet_edges.h"

namespace affskel::core {

/// When a fire that is lit at all rims of a sheet at once, and goes along it at unit speed, burns each of its vertices (the
/// burn time of Yan, Sykes, Chambers, Letscher and Ju, "Erosion thickness on medial axes of 3D shapes", 2016).  Where sheets
/// meet it waits until all of them but one have burned: the rim of a fin is none of the sheet that it stands on.  What such a
/// wait never lets burn, as a closed surface with a fin, burns as if the fire had not to wait there.
/// @param left per triangle: whether it is there. @param held per vertex: not 0 where something begins that does not burn.
/// @return per vertex; infinity where no fire comes.
std::vector<double> burn_times(const SheetMesh& sheet, const SheetEdges& edges, std::span<const char> left,
                               std::span<const char> held);

}  // namespace affskel::core

#pragma once

#include <cstdint>
#include <vector>

#include "core/contour/sheet_mesh.h"
#include "core/curve/limb_hubs.h"
#include "core/curve/limb_surface.h"

namespace affskel::core {

/// Lines in a plate that limbs hang on, as in a palm or a seat, run another way at each spacing, and noise moves their
/// joints.  Where a hub is one, its second axis 1.8 times the shortest and its longest at most twice that, its lines are
/// drawn anew: from where each limb leaves it straight on, and round to its middle.  Limbs that it holds whole have no line
/// any more.  Lines keep their pieces and tunnels: a hub whose lines are no tree keeps these, and so does one that has less
/// than three limbs, that touches another, or where a new line would come near the surface.
/// @param surface, curve in the same coordinates; segments and no triangles.
/// @param hubs of its lines; follows them.
/// @param spacing between vertices of new lines, > 0.
/// @return per vertex before: its number now, of lines that are gone that of their hub's middle; empty where all stay as they
///   are.
std::vector<std::uint32_t> draw_hub_stars(const LimbSurface& surface, double spacing, LimbHubs& hubs,
                                          SheetMesh& curve);

}  // namespace affskel::core

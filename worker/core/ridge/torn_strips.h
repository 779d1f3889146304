#pragma once

#include <span>
#include <vector>

#include "core/contour/sheet_mesh.h"
#include "core/ridge/ridge_constants.h"
#include "core/ridge/ridge_curves.h"

namespace affskel::core {

/// The parts of round stretches along which the sheet about the curve is no strip: where E bends nearly alike
/// in all directions across the curve, neighbouring lattice edges see sheets of different directions, which
/// tear and cross.  A window of a stretch is torn when the triangles beside it form tunnels or pockets, by
/// Euler's formula, or there are none.  What lies in a torn window, or is round by the bound, is returned.
/// @param mesh without segments; cut (see cut_rims()).
/// @param stretches of its curves, see round_stretches().
/// @return in the order of the stretches, along each of them.
std::vector<RidgeCurve> torn_stretches(const SheetMesh& mesh, std::span<const RidgeCurve> stretches,
                                       const RidgeConstants& constants = {});

}  // namespace affskel::core

#pragma once

#include <span>
#include <vector>

#include "core/contour/sheet_mesh.h"
#include "core/ridge/ridge_curves.h"

namespace affskel::core {

struct TornStripOptions {
  double reach = 1;  ///< how far from a curve its sheet reaches, in the radius of the section, > 0
  /// Strips are looked at in windows of this length, radii, > 0, each one `step` on from the one before.
  double window = 1.25;
  double step = 0.5;
  /// From this lambda_2 / lambda_1 on the strip's direction is chance, 0 .. 1.
  double round_ratio = 0.9;
};

/// The parts of round stretches along which the sheet about the curve is no strip: where E bends nearly alike
/// in all directions across the curve, neighbouring lattice edges see sheets of different directions, which
/// tear and cross.  A window of a stretch is torn when the triangles beside it form tunnels or pockets, by
/// Euler's formula, or there are none.  What lies in a torn window, or is round by the bound, is returned.
/// @param mesh without segments; cut (see cut_rims()).
/// @param stretches of its curves, see round_stretches().
/// @return in the order of the stretches, along each of them.
/// @throws CoreError kBadInput when an option is out of range.
std::vector<RidgeCurve> torn_stretches(const SheetMesh& mesh, std::span<const RidgeCurve> stretches,
                                       const TornStripOptions& options = {});

}  // namespace affskel::core

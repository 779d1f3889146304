#pragma once

#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/thinned_solid.h"

namespace affskel::core {

/// Where a limb of the solid ends: the end of the line that is left of it when the solid is thinned.
struct LimbTip {
  DualComplex::Cell vertex = 0;
  double radius = 0;    ///< distance of its root, where the limb begins to be one, to the surface, spacings
  double width = 0;     ///< half the limb's width there, across its wider side, spacings
  double reach = 0;     ///< the greatest way along the line from there over the birth of an edge
  double length = 0;    ///< the greatest way, spacings
  bool is_cut = false;  ///< it ends at a lone edge that was taken out
};

/// What is found as lines are eaten.
struct LimbTips {
  std::vector<LimbTip> tips;  ///< by the order in which they were found
  CellSet left;  ///< loops, closed surfaces, lines between them: what has no end to be eaten from
};

/// The tips of the limbs of a solid (isolation and removal of cells in thinning: Liu, Chambers, Letscher and
/// Ju 2010).  The complex is collapsed from the surface inwards at unit speed.  A lone edge, one whose last
/// square has gone, is born then; lone edges are eaten from the ends of their line, and live until then.
/// While births grow fast from the end of a line inwards, as from a bump to the middle of a head, or along the
/// middle of a foot's blunt front, the line says nothing: the limb begins where that ends, and for good once it is half
/// as long as wide.  From there on the line must have an edge whose way from there, and whose life, are `least_reach`
/// times the time of its birth: the limb is longer than it is wide.  Its tip lies farther out, as long as the distance
/// to the surface does not grow fast; of a flat end it lies in the middle between its corners.
/// @param solid see thinned_solid().
/// @param cuts squares and edges that are taken out as soon as they have no coface: a limb with a loop has no tip.
/// A function of its arguments alone.
/// @throws CoreError kCancelled when the context asks to stop.
LimbTips limb_tips(ThinnedSolid solid, double least_reach, std::span<const DualComplex::Cell> cuts = {},
                   ExecutionContext* context = nullptr);

}  // namespace affskel::core

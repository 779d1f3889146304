#pragma once

#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/curve/limb_surface.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

struct CentreLinesInput {
  const LimbSurface& surface;         ///< of the solid
  std::span<const Segment> segments;  ///< of the lines, as for polylines()
  /// Per vertex: where the end of a line is known to lie about, else nothing is known.
  std::span<const Vec3> tip;
  std::span<const char> has_tip;
  double spacing = 0;    ///< of the lattice: what tells ends apart
  unsigned threads = 1;  ///< the result does not depend on it
  ExecutionContext* context = nullptr;
};

/// Draws lines through limbs in their middle.  They are made smooth without becoming shorter (Taubin, "A signal
/// processing approach to fair surface design", 1995).  Where a limb is one, each vertex goes to the centroid of the
/// section across (see LimbSections).  Where limbs meet, in the largest ball about the joint, sections say nothing: the
/// joint goes to where the lines of its limbs would meet (least squares), straight on from there; where these are about
/// parallel, to where the limbs part as far from it as they are thick (see LimbFork).  Free ends: see draw_end().
/// No vertex leaves the solid: each stays in a ball that does not.
/// @param places per vertex, in the surface's coordinates, within the solid.
/// @throws CoreError kCancelled when the context asks to stop.
void centre_lines(const CentreLinesInput& input, std::vector<Vec3>& places);

}  // namespace affskel::core

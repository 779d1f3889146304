#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/limb_tips.h"
#include "core/collapse/shortest_ways.h"
#include "core/contour/edge_cells.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice_edges.h"
#include "core/lattice/solid_parts.h"
#include "core/ridge/ridge_constants.h"
#include "core/ridge/ridge_curves.h"

namespace affskel::core {

/// What anchors are chosen from.
struct RidgeEvidence {
  const DualComplex& complex;
  const SolidParts& parts;
  const FrameField& field;
  std::span<const LatticeEdge> edges;            ///< that the ridge surface crosses, from a weak strength on
  std::span<const double> strength;              ///< of these crossings
  const EdgeCells& cells;                        ///< of these edges
  std::span<const SheetVertex> vertices;         ///< of the surface, one per cell
  std::span<const RidgeCurve> curves;            ///< from the lower bound on
  std::span<const LimbTip> limbs;                ///< of the solid
  std::span<const float> radius;                 ///< per sample point: distance to the surface, spacings
  std::span<const char> doubtful;                ///< per limb, or empty: see possible_spikes()
  std::span<const DualComplex::Cell> core = {};  ///< what thinning leaves: see RidgeBasis
};

/// A place on a ridge curve, for the vertex of the complex that is dual to its cell.
struct CurvePlace {
  DualComplex::Cell vertex = 0;
  SheetVertex at;
};

/// That a limb's line ends at its tip.
inline Anchor anchor_of(const LimbTip& tip) {
  return {tip.vertex, 0, true};
}

struct RidgeAnchors {
  std::vector<Anchor> anchors;     ///< each cell once
  std::vector<CurvePlace> curves;  ///< by vertex, each once
  std::vector<Anchor> core;  ///< far from these, each cell once; they hold only while the solid collapses
  std::uint32_t limbs = 0;   ///< tips among the anchors
  std::vector<LimbTip> doubtful;  ///< that would be, but may be spikes
  /// Per cube: it belongs to a fragment, a component beside a larger one of the same part of the solid, where the
  /// lattice does not resolve it: it is nowhere three points thick.  No skeleton is wanted of it, unless it has a tunnel
  /// or a void, for these are the lattice's.
  std::vector<char> left_out;
  std::uint32_t fragments = 0;
};

/// What a collapse of the solid must leave of its ridges.
/// 1. The surface where it is strong (see surface_squares()), in pieces that have a vertex of s >= high that is not round,
///    and area enough.
/// 2. Stretches of ridge curves, off that, that are long enough.
/// 3. Tips of limbs that end far from both.
/// 4. Of what thinning leaves, loops and closed surfaces, what is far from all these: a collapse that nothing leads draws
///    all the loops of a frame from one of its corners, side by side through its rods.  The lattice's own tunnels are among
///    them, so that these hold only until tunnels are filled.
/// 5. Where these do not come near the middle of a component of the complex, where E^(1/4) times the distance to the
///    surface is greatest, the longest stretch of a curve that does, or else the vertex there.
/// The lower the bounds, the more.  A function of its arguments alone.
/// @throws CoreError kBadInput when a bound is out of range; kCancelled when the context asks to stop.
RidgeAnchors ridge_anchors(const RidgeEvidence& evidence, const RidgeBounds& bounds,
                           ExecutionContext* context = nullptr);

}  // namespace affskel::core

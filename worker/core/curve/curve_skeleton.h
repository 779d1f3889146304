#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/vec3.h"
#include "core/contour/sheet_mesh.h"
#include "core/curve/limb_surface.h"
#include "core/lattice/lattice.h"
#include "core/ridge/ridge_sheet.h"
#include "core/solid/solid.h"

namespace affskel::core {

struct CurveInput {
  const Solid& solid;
  const Lattice& lattice;      ///< of this solid
  const RidgeBasis& basis;     ///< of a field of this lattice
  const RidgeSheet& ridge;     ///< its skeleton
  const LimbSurface& surface;  ///< see limb_surface(): what all thresholds share
};

struct CurveOptions {
  /// Limbs that are shorter, by their own radius, have no branch; see LimbTip::reach; flat ones, by how far they
  /// lead out of what there is without them over HangingPatch::width.  Below RidgeConstants::limb_reach no more tips come.
  double least_reach = 0.9;
  unsigned threads = 1;                 ///< the result does not depend on it
  ExecutionContext* context = nullptr;  ///< asked whether to stop
};

/// A closed surface of the ridge, opened: a cavity has no line round it.
struct Opening {
  Vec3 place;           ///< where E is least on it, frame coordinates
  double distance = 0;  ///< to the surface of the solid, mesh units
};

/// Lines through the limbs of a solid: vertices and segments, no triangle.
struct CurveSkeleton : SheetMesh {
  std::vector<double> distance;  ///< per vertex: to the surface of the solid, mesh units
  std::vector<double> slice;  ///< per vertex: of all sample points, those that it is nearest to; adds up to 1
  std::vector<double> share;  ///< per vertex: of all sample points, those of `nearest`; adds up to 1
  std::vector<double> radius;  ///< per vertex: see limb_radii(), mesh units
  std::vector<double> beyond;  ///< per vertex: share of all sample points; see volume_beyond()
  /// Per sample point: the vertex that it belongs to, see realms(), and limb_tubes() where limbs meet; of a fragment,
  /// where no way leads, the nearest.
  std::vector<std::uint32_t> nearest;
  std::uint32_t branches = 0;  ///< between ends and places where lines meet; a loop without one counts once
  std::uint32_t ends = 0;      ///< of one branch alone
  std::vector<Opening> opened;
  double same_to = 0;  ///< the least reach of its limbs, infinity without: up to there all thresholds give it
};

/// The curve skeleton: the skeleton of `ridge`, collapsed on to the middle of its surfaces (see sheet_lines()),
/// with a branch straight on to the tip of every limb that is long enough.  It has the pieces and tunnels of that
/// skeleton, but for what noise bores where a surface crosses itself, see pruned_lines().  Lines are then made smooth
/// without becoming shorter (Taubin, "A signal processing approach to fair surface design", 1995), within the solid;
/// in flat bodies that limbs hang on they are drawn anew, see draw_hub_stars().  A vertex keeps the values of the place
/// on the ridge that it comes from, as far as a few spacings away; one that is drawn anew has those of the nearest.
/// @throws CoreError kBadInput for a reach that is not finite or not above 0; kCancelled when the context asks to
///   stop.
CurveSkeleton curve_skeleton(const CurveInput& input, const CurveOptions& options = {});

/// Its lines alone, without what is measured of the solid.
SheetMesh curve_lines(const CurveInput& input, const CurveOptions& options = {});

/// The surface of a solid in the frame of its lattice, on up to `threads` threads.
LimbSurface limb_surface(const Solid& solid, const Lattice& lattice, unsigned threads = 1);

}  // namespace affskel::core

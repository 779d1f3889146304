#pragma once

#include <cstdint>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/limb_tips.h"
#include "core/contour/sheet_mesh.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/ridge/filled_tunnels.h"
#include "core/ridge/ridge_constants.h"
#include "core/ridge/skeleton_mesh.h"
#include "core/ridge/smoothed_derivatives.h"
#include "core/ridge/unreached_ends.h"
#include "core/solid/betti_numbers.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// A tunnel of the complex.
struct LatticeLoop {
  Vec3 place;       ///< the middle of a loop round it, frame coordinates
  double size = 0;  ///< of the loop, across, spacings
};

/// What the skeletons of one field at all thresholds share.
struct RidgeBasis {
  DualComplex complex;
  BettiNumbers topology = {};         ///< of the complex
  std::vector<float> radius = {};     ///< per sample point: see surface_distance()
  std::vector<float> thickness = {};  ///< see section_radii(); empty where no surface crosses itself
  std::vector<LimbTip> limbs = {};    ///< of the solid, whatever is anchored
  /// Where the lattice has tunnels that the solid lacks: limbs beside these, which end where a tunnel is opened.  Of a
  /// noisy solid none: its skeleton is opened, too.
  std::vector<LimbTip> cut_limbs = {};
  /// What thinning leaves: the squares of closed surfaces, the edges of loops and of lines between them.
  std::vector<DualComplex::Cell> core = {};
  std::vector<LatticeLoop> loops = {};             ///< the smallest tunnels, kMaxLoops at most
  std::vector<PointDerivatives> derivatives = {};  ///< see smoothed_derivatives()
};

inline constexpr std::size_t kMaxLoops = 8;

/// @param lattice of this solid.
/// @param field of this lattice.
/// @param threads >= 1; the result does not depend on it.
/// @throws CoreError kCancelled when the context asks to stop.
RidgeBasis ridge_basis(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       unsigned threads = 1, ExecutionContext* context = nullptr);

struct RidgeSheetOptions {
  RidgeBounds bounds;
  unsigned threads = 1;                 ///< the result does not depend on it
  ExecutionContext* context = nullptr;  ///< asked whether to stop, between the steps and in long ones
};

/// The ridge of the E field, made a skeleton of the solid: surfaces, and curves (segments).
/// Lines end where limbs begin to end, as curve_skeleton() takes them; draw_out() leads them on to the tips.
struct RidgeSheet : SkeletonMesh {
  /// Of the complex dual to the lattice, with a disc across each tunnel that the solid lacks: the skeleton's and its
  /// fragments', by theorem.
  BettiNumbers lattice;
  FilledTunnels filled;                 ///< by such discs
  std::uint32_t fragments = 0;          ///< components of the complex left out, see RidgeAnchors
  std::uint32_t limbs = 0;              ///< tips of limbs that no ridge reaches, which lines lead to
  std::vector<UnreachedEnd> unreached;  ///< see unreached_ends()
  std::uint32_t opened = 0;             ///< pockets of the ridge, opened; see collapse()
  /// The greatest strength of what may found a ridge; 0 where none has RidgeConstants::weak_share of the least.
  double strongest = 0;
};

/// The skeleton as a ridge: the surface where E is greatest across the direction in which it bends most, a
/// height ridge of codimension 1 (Haralick 1983; Eberly 1996; as a crease surface Schultz, Theisel and Seidel
/// 2010), where the normals of the level surfaces turn fast, and the curve in the middle of round limbs. Every
/// shock is on one, with a strength that grows without bound as the lattice becomes finer; so is the middle
/// sheet of a smooth body, which is no shock.  The solid is collapsed onto them (see collapse()), so that the
/// skeleton has its pieces, tunnels and voids, as far as the lattice resolves them.  README.md in worker/core
/// tells how and why.
///
/// Each part of the solid (see SolidParts) has the skeleton that it would have alone.  A function of solid,
/// lattice and field alone.
/// @param lattice of this solid.
/// @param field of this lattice.
/// @param basis of this field, for all sheets of it.
/// @throws CoreError kBadInput when a bound is not finite or out of range, or the basis is not of as many
///   points; kLimit for 2^30 crossings and more; kCancelled when the context asks to stop.
RidgeSheet ridge_sheet(const Solid& solid, const Lattice& lattice, const FrameField& field,
                       const RidgeBasis& basis, const RidgeSheetOptions& options = {});

}  // namespace affskel::core

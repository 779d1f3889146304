#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/collapse.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/limb_tips.h"
#include "core/lattice/lattice.h"
#include "core/ridge/ridge_constants.h"
#include "core/solid/solid.h"

namespace affskel::core {

struct FillOptions {
  double limb_reach = RidgeConstants{}.limb_reach;
  std::uint64_t voids = 0;           ///< of the complex
  std::span<const float> thickness;  ///< per sample point where the surface crosses itself: section_radii()
  ExecutionContext* context = nullptr;
};

struct FilledTunnels {
  std::uint32_t number = 0;
  std::uint32_t voids = 0;  ///< of noise, opened
  /// What hung loose and stays.  limb_tips() sees none of them: while the solid is thinned they are a loop.
  std::vector<LimbTip> limbs;
};

/// Fills the tunnels that a collapsed complex has and the solid lacks: where the solid is thinner than the
/// spacing, as in a web between fingers, the complex has a hole.  A loop within the solid that bounds a surface
/// there (see is_linked()) has a disc put across it; the disc is collapsed from an edge of the loop, which goes
/// with it, and what hangs loose then as far as the anchors.  So the edge alone is taken out: of those of no square
/// that are no anchors the one that is nearest to the surface.  What hangs loose and is as long as a limb stays: two
/// fingers that the lattice joins at their tips.  A sum of loops may be filled where none of them may.
///
/// Noise that makes a surface cross itself bores tunnels through limbs, and its loops are not those of the outside.
/// There the shortest loops of the complex count, as many as it has more than the surface has handles, as far as each
/// lies within kOfNoise times the limb's thickness at one of its places: a tunnel of a limb's, not one
/// between limbs that pass through each other.  What encloses a void there is opened before.
///
/// Nothing is filled where several surfaces cross, where what is left encloses voids
/// all the same, and where there are more than
/// kMostTunnels of the complex, or kMostOfNoise.
/// @param radius per sample point: distance to the surface.
/// @param left of the collapse.
/// A function of its arguments alone.
/// @throws CoreError kCancelled when the context asks to stop.
FilledTunnels fill_tunnels(const Solid& solid, const Lattice& lattice, const DualComplex& complex,
                           std::span<const Anchor> anchors, std::span<const float> radius, CellSet& left,
                           const FillOptions& options = {});

inline constexpr std::size_t kMostTunnels = 64;  ///< with more the lattice resolves no solid at all
inline constexpr std::size_t kMostOfNoise = 512;
inline constexpr double kOfNoise = 2;

}  // namespace affskel::core

#pragma once

#include <span>
#include <vector>

#include "core/base/execution_context.h"
#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/limb_tips.h"
#include "core/collapse/shortest_ways.h"
#include "core/lattice/lattice.h"
#include "core/solid/solid.h"

namespace affskel::core {

struct FilledTunnels {
  std::vector<DualComplex::Cell> edges;  ///< that are taken out, one of each
  /// What hung loose and stays: RidgeBasis::limbs has none of them.
  std::vector<LimbTip> limbs;
};

/// Fills the tunnels that a collapsed complex has and the solid lacks: where the solid is thinner than the
/// spacing, as in a web between fingers, the complex has a hole.  A loop within the solid that bounds a surface
/// there (see is_linked()) has a disc put across it; the disc is collapsed from an edge of the loop, which goes
/// with it, and what hangs loose then as far as the anchors.  So the edge alone is taken out: of those of no square
/// that are no anchors the one that is nearest to the surface.  What hangs loose and is as long as a limb stays: two
/// fingers that the lattice joins at their tips.  A sum of loops may be filled where none of them may.
///
/// Nothing is filled where the surface crosses itself, so that its loops are not those of the outside, where what
/// is left encloses voids, and where there are more than kMostTunnels of the complex.
/// @param radius per sample point: distance to the surface.
/// @param left of the collapse.
/// A function of its arguments alone.
/// @throws CoreError kCancelled when the context asks to stop.
FilledTunnels fill_tunnels(const Solid& solid, const Lattice& lattice, const DualComplex& complex,
                           std::span<const Anchor> anchors, std::span<const float> radius, CellSet& left,
                           ExecutionContext* context = nullptr);

inline constexpr std::size_t kMostTunnels = 64;  ///< with more the lattice resolves no solid at all

}  // namespace affskel::core

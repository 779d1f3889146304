#pragma once

#include <span>
#include <vector>

#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/limb_tips.h"
#include "core/lattice/lattice.h"
#include "core/mesh/mesh.h"
#include "core/solid/solid.h"

namespace affskel::core {

/// The limbs of a solid, some of which may be spikes that noise has pulled out of its surface.
struct SpikyLimbs {
  const DualComplex& complex;
  std::span<const float> radius;     ///< per sample point: distance to the surface, spacings
  std::span<const float> thickness;  ///< per sample point, spacings: see section_radii()
  std::span<const LimbTip> tips;
  double noise =
      0;  ///< root of the mean squared distance that smoothing moves the surface's vertices by, spacings
};

/// Which limbs may be spikes: those about whose tips the surface crosses itself, no farther away than the surface and the
/// noise, or all where it does so at kNoisy of its triangles, that are no longer than kSpike times the noise, nor than the
/// solid is thick somewhere.
/// @param walls the solid's surface in lattice coordinates.
/// @return per limb; empty where no surface crosses itself: of a model of parts that overlap every limb is one.
std::vector<char> possible_spikes(const Solid& solid, const Mesh& walls, const Lattice& lattice,
                                  const SpikyLimbs& limbs);

/// Those limbs that are none: a spike is no longer than the limb is thick that it stands on, and ends no farther than
/// that and its length from the limb's skeleton.
/// @param skeleton of the solid without these limbs.
std::vector<LimbTip> limbs_without_spikes(const SpikyLimbs& limbs, const CellSet& skeleton);

inline constexpr double kSpike = 6, kNoisy = 0.2;

}  // namespace affskel::core

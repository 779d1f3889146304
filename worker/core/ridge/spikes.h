#pragma once

#include <span>
#include <vector>

#include "core/collapse/cell_sets.h"
#include "core/collapse/dual_complex.h"
#include "core/collapse/limb_tips.h"

namespace affskel::core {

/// The limbs of a solid, some of which may be spikes that noise has pulled out of its surface.
struct SpikyLimbs {
  const DualComplex& complex;
  std::span<const float> thickness;  ///< per sample point, spacings: see section_radii()
  std::span<const LimbTip> tips;
  /// Of a surface that crosses itself: root of the mean squared distance that smoothing moves its vertices by, spacings.
  double noise = 0;
};

/// Which limbs may be spikes: those that are no longer than kSpike times the noise, nor than the solid is thick somewhere.
/// @return per limb; empty where there is no noise.
std::vector<char> possible_spikes(const SpikyLimbs& limbs);

/// Those limbs that are none: a spike is no longer than the limb is thick that it stands on, and ends no farther than
/// that and its length from the limb's skeleton.
/// @param skeleton of the solid without these limbs.
std::vector<LimbTip> limbs_without_spikes(const SpikyLimbs& limbs, const CellSet& skeleton);

inline constexpr double kSpike = 6;

}  // namespace affskel::core

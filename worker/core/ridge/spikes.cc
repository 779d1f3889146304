#include "core/ridge/spikes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/collapse/shortest_ways.h"
#include "core/ridge/ridge_constants.h"

namespace affskel::core {
namespace {

// The longest spike on a limb of that thickness, spacings.
double longest_spike(float thickness) {
  return RidgeConstants::end_spacings + RidgeConstants::end_radii * static_cast<double>(thickness);
}

double longest_spike(const SpikyLimbs& limbs) {
  return longest_spike(*std::max_element(limbs.thickness.begin(), limbs.thickness.end()));
}

}  // namespace

std::vector<char> possible_spikes(const SpikyLimbs& limbs) {
  if (limbs.noise == 0) return {};
  const double longest = std::min(kSpike * limbs.noise, longest_spike(limbs));
  std::vector<char> possible;
  possible.reserve(limbs.tips.size());
  for (const LimbTip& tip : limbs.tips) possible.push_back(tip.length <= longest);
  return possible;
}

std::vector<LimbTip> limbs_without_spikes(const SpikyLimbs& limbs, const CellSet& skeleton) {
  if (limbs.tips.empty()) return {};
  std::vector<char> has_skeleton(limbs.complex.cubes(), 0);
  skeleton.for_each([&](DualComplex::Cell cell) {
    for (const auto& member : limbs.complex.star(cell)) has_skeleton[member.cube] = 1;
  });
  const double longest = longest_spike(limbs);
  std::vector<LimbTip> result;
  for (const LimbTip& tip : limbs.tips) {
    const auto stands_on = [&](std::uint32_t cube, float way) {
      const double spike = longest_spike(limbs.thickness[cube]);
      return has_skeleton[cube] != 0 && tip.length <= spike && static_cast<double>(way) <= tip.length + spike;
    };
    if (!is_near(limbs.complex, tip.vertex, static_cast<float>(tip.length + longest), stands_on))
      result.push_back(tip);
  }
  return result;
}

}  // namespace affskel::core

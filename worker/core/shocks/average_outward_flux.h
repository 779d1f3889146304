#pragma once

#include <numbers>

#include "base/published_threshold.h"
#include "core/shocks/neighbourhood.h"

namespace affskel::core {

/// Threshold for |H|, without unit and whatever the spacing: on a lattice H is Zucker and Hummel's / 26.
constexpr double kAverageOutwardFluxThreshold = base::kZuckerHummelThreshold / 26;

/// H = div n as the average outward flux through the sphere of the 26 neighbours (divergence theorem; Siddiqi,
/// Bouix, Tannenbaum and Zucker 2002, section 4): the mean of n(neighbour) . outward unit vector.  Negative at
/// sinks of n, positive at sources.  |H| <= 1.
///
/// With s a step to a neighbour, the sum of n(x + s) . s / |s| over the 26 of them is, regrouped by axes,
/// Zucker and Hummel's sum of differences: their weights 1, sqrt(2)/2, sqrt(3)/3 are the 1 / |s|.  So the
/// average outward flux is their H / 26, and 7 / 26 keeps the same points, up to rounding.
inline double average_outward_flux(const Neighbourhood& normals, double /*spacing*/) {
  // 1 / |s| by the number of axes that s leaves along, 1 to 3.
  constexpr std::array<double, 4> kInverseLength{0, 1, std::numbers::sqrt2 / 2, std::numbers::inv_sqrt3};
  double sum = 0;
  // Opposite neighbours together, so that equal normals give exactly 0.
  for (int i = 0; i <= 1; ++i) {
    for (int j = i == 0 ? 0 : -1; j <= 1; ++j) {
      for (int k = i == 0 && j == 0 ? 1 : -1; k <= 1; ++k) {
        const auto squared_length = static_cast<std::size_t>(i * i + j * j + k * k);
        const Vec3 n = normals.at({i, j, k}) - normals.at({-i, -j, -k});
        sum += kInverseLength[squared_length] * ((i * n.x + j * n.y) + k * n.z);
      }
    }
  }
  return sum / 26;
}

}  // namespace affskel::core

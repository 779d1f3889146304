#pragma once

#include <numbers>

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

/// H = div n by the operator of Zucker and Hummel (1981) in its symmetric form: the derivative along a lattice
/// axis is the weighted sum of the differences of the 9 pairs of neighbours in the planes before and behind,
/// each by the inverse of its distance across them, not divided by weights or spacing, so that
/// base::kZuckerHummelThreshold applies.  |H| <= 3 * 2 * (1 + 2 sqrt(2) + 4 sqrt(3)/3).
inline double zucker_hummel_divergence(const Neighbourhood& normals, double /*spacing*/) {
  return weighted_plane_differences(normals, {1, std::numbers::sqrt2 / 2, std::numbers::inv_sqrt3});
}

}  // namespace affskel::core

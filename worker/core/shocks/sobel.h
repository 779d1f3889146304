#pragma once

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

/// Threshold for |H|, without unit and whatever the spacing: keeps the same jumps as Zucker-Hummel's 7.
///
/// At a sheet parallel to two axes where the normal component across jumps by J, a point beside the sheet gets
/// |H| = J times the weights of a plane: 1 + 2 sqrt(2) + 4 sqrt(3)/3 for Zucker-Hummel, 16 here.
/// 7 * 16 / (1 + 2 sqrt(2) + 4 sqrt(3)/3) = 18.247.
constexpr double kSobelThreshold = 18.25;

/// H = div n by the 3D Sobel operator (masks: Zografos 2003, appendix B.2): the derivative along a lattice
/// axis is the sum of the differences of the 9 pairs of neighbours in the planes before and behind, weighted
/// 1 2 1 across 1 2 1, without the published factor 1/32 and not divided by the spacing.  |H| <= 3 * 2 * 16.
inline double sobel_divergence(const Neighbourhood& normals, double /*spacing*/) {
  return weighted_plane_differences(normals, {4, 2, 1});
}

}  // namespace affskel::core

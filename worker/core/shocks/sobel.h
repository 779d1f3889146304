#pragma once

#include <vector>

#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Threshold for |H|, without unit and whatever the spacing: keeps the same jumps as Zucker-Hummel's 7.
constexpr double kSobelThreshold = 18.25;

/// H = div n of the optimal normals at every sample point, by the 3D Sobel operator (masks: Zografos 2003,
/// appendix B.2): the derivative along a lattice axis is the sum of the differences of the 9 pairs of
/// neighbours in the planes before and behind, weighted 1 2 1 across 1 2 1, without the published factor
/// 1/32 and not divided by the spacing.  A neighbour outside the solid counts as the centre itself.
/// @param directions unit normals in the lattice's frame (see frame_directions).
/// Returns one value per point; |H| <= 3 * 2 * 16.
std::vector<double> sobel_divergence(const Lattice& lattice, const DirectionSet& directions,
                                     const OptimalDirections& optimal,
                                     ExecutionContext* context = nullptr);

}  // namespace affskel::core

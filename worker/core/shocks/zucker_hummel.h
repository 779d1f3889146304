#pragma once

#include <vector>

#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// H = div n of the optimal normals at every sample point, by the operator of Zucker and Hummel (1981) in
/// its symmetric form: the derivative along a lattice axis is the weighted sum of the differences of the
/// 9 pairs of neighbours in the planes before and behind, each by the inverse of its distance across them,
/// not divided by weights or spacing, so that base::kZuckerHummelThreshold applies.  A neighbour outside the solid counts as the centre itself.
/// @param directions unit normals in the lattice's frame (see frame_directions).
/// Returns one value per point; |H| <= 3 * 2 * (1 + 2 sqrt(2) + 4 sqrt(3)/3).
std::vector<double> zucker_hummel_divergence(const Lattice& lattice, const DirectionSet& directions,
                                             const OptimalDirections& optimal,
                                             ExecutionContext* context = nullptr);

}  // namespace affskel::core

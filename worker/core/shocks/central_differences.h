#pragma once

#include <vector>

#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Threshold for |H|, per mesh unit: 0.57 / spacing, which keeps the same jumps as Zucker-Hummel's 7.
inline double central_difference_threshold(double spacing) {
  return 0.57 / spacing;
}

/// H = div n of the optimal normals at every sample point, by central differences: the derivative along a
/// lattice axis is (n(x + e) - n(x - e)) / (2 spacing) (Zografos 2003, section 3.2.2).  A sheet shows on both
/// sides.  A neighbour outside the solid counts as the point itself.
/// @param directions unit normals in the lattice's frame (see frame_directions).
/// Returns one value per point, per mesh unit; |H| <= 3 / spacing.
std::vector<double> central_difference_divergence(const Lattice& lattice, const DirectionSet& directions,
                                                  const OptimalDirections& optimal,
                                                  ExecutionContext* context = nullptr);

}  // namespace affskel::core

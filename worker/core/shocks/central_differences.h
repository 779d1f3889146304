#pragma once

#include <vector>

#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Threshold for |H|, per mesh unit: alpha / spacing with alpha = 0.57.  The published rule says "of the
/// order of unity" (Betelu et al. 2001).  At a sheet parallel to two axes where the normal component across
/// jumps by J <= 2, |H| = J / (2 spacing): alpha = 1 would keep no point of it even where the normals are
/// opposite.  0.57 stands for the jump that Zucker-Hummel's 7 does, J = 1.14.
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

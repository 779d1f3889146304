#pragma once

#include <vector>

#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Threshold for |H|, per mesh unit: alpha / spacing with alpha = 1 (Betelu et al. 2001: "of the order of
/// unity"; Zografos 2003, sections 3.2.2 and 6.2.2: appropriate with this operator).  At a sheet parallel to
/// two axes alpha is the jump J of the normal component across it; Zucker-Hummel's 7 stands for J = 1.14.
inline double intermediate_difference_threshold(double spacing) {
  return 1 / spacing;
}

/// H = div n of the optimal normals at every sample point, by intermediate differences: the derivative along
/// a lattice axis is (n(x + e) - n(x)) / spacing (Betelu et al. 2001; Zografos 2003, section 3.2.2).  A sheet
/// shows on its lower side only, one point thick.  A neighbour outside the solid counts as the point itself.
/// @param directions unit normals in the lattice's frame (see frame_directions).
/// Returns one value per point, per mesh unit; |H| <= 3 * 2 / spacing.
std::vector<double> intermediate_difference_divergence(const Lattice& lattice, const DirectionSet& directions,
                                                       const OptimalDirections& optimal,
                                                       ExecutionContext* context = nullptr);

}  // namespace affskel::core

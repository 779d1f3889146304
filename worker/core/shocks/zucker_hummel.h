#pragma once

#include <vector>

#include "core/erosion/directions.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

struct ZuckerHummelOptions {
  double face_weight = 1;                         ///< for the pair of neighbours across a face
  double edge_weight = 0.70710678118654752440;    ///< sqrt(2)/2, for the 4 pairs across edges
  double corner_weight = 0.57735026918962576451;  ///< sqrt(3)/3, for the 4 pairs across corners
};

/// H = div n of the optimal normals at every sample point, by the operator of Zucker and Hummel (1981) in
/// its symmetric form: the derivative along a lattice axis is the weighted sum of the differences of the
/// 9 pairs of neighbours in the planes before and behind, not divided by weights or spacing, so that
/// base::kZuckerHummelThreshold applies.  A neighbour outside the solid counts as the centre itself.
/// @param directions unit normals in the lattice's frame (see frame_directions).
/// Returns one value per point; |H| <= 3 * 2 * (1 + 2 sqrt(2) + 4 sqrt(3)/3).
std::vector<double> zucker_hummel_divergence(const Lattice& lattice, const DirectionSet& directions,
                                             const OptimalDirections& optimal,
                                             const ZuckerHummelOptions& options = {},
                                             ExecutionContext* context = nullptr);

}  // namespace affskel::core

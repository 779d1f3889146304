#pragma once

#include <vector>

#include "core/directions.h"
#include "core/lattice.h"

namespace affskel::core {

/// Optimal direction per sample point: indices into a direction set, FieldValue::kNoDirection = none yet.
using OptimalDirections = std::vector<std::uint32_t>;

struct ZuckerHummelOptions {
  double face_weight = 1;                         ///< for the pair of neighbours across a face
  double edge_weight = 0.70710678118654752440;    ///< sqrt(2)/2, for the 4 pairs across edges
  double corner_weight = 0.57735026918962576451;  ///< sqrt(3)/3, for the 4 pairs across corners
};

/// H = div n of the optimal normals at every sample point, by the operator of Zucker and Hummel (1981) in
/// its symmetric form: the derivative along a lattice axis is the weighted sum of the differences of the
/// 9 pairs of neighbours in the planes before and behind, not divided by weights or spacing, so that
/// Zografos' (2003, section 6.2.2) threshold of 7 applies.  A neighbour outside the solid counts as the
/// centre itself.  n are components along x, y, z; the lattice must be parallel to the axes.
/// Returns one value per point; |H| <= 3 * 2 * (1 + 2 sqrt(2) + 4 sqrt(3)/3).
std::vector<double> zucker_hummel_divergence(const Lattice& lattice, const DirectionSet& directions,
                                             const OptimalDirections& optimal,
                                             const ZuckerHummelOptions& options = {});

}  // namespace affskel::core

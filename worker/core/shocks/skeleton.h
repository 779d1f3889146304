#pragma once

#include <cstdint>
#include <vector>

#include "base/published_threshold.h"

namespace affskel::core {

struct SkeletonPoint {
  std::uint32_t point = 0;  ///< sample point
  double divergence = 0;    ///< H
};

/// The thresholded affine skeleton (Zografos 2003, section 3.4): sample points where the normals of the
/// level surfaces of E jump, |H| > threshold, in lattice order.
/// @param threshold of the operator that gave H (see shock_operator.h).
/// @throws CoreError kBadInput when the threshold is not a finite number > 0.
std::vector<SkeletonPoint> skeleton_points(const std::vector<double>& divergence,
                                           double threshold = base::kZuckerHummelThreshold);

}  // namespace affskel::core

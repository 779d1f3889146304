#include "core/shocks/skeleton.h"

#include <cmath>

#include "base/number_text.h"
#include "core/base/error.h"

namespace affskel::core {

std::vector<SkeletonPoint> skeleton_points(const std::vector<double>& divergence, double threshold) {
  if (!(threshold > 0) || !std::isfinite(threshold)) {
    refuse("the threshold must be a finite number > 0, not " + base::to_text(threshold));
  }
  std::vector<SkeletonPoint> kept;
  for (std::size_t p = 0; p < divergence.size(); ++p) {
    if (std::abs(divergence[p]) > threshold) kept.push_back({static_cast<std::uint32_t>(p), divergence[p]});
  }
  return kept;
}

}  // namespace affskel::core

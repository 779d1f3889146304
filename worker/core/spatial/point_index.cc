#include "core/spatial/point_index.h"

#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace affskel::core {

PointIndex::PointIndex(std::span<const Vec3> points) : points_(points.begin(), points.end()) {
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw CoreError(CoreError::Code::kLimit, "too many points to index: " + std::to_string(points.size()));
  }
  std::vector<std::uint32_t> items(points_.size());
  std::iota(items.begin(), items.end(), 0U);
  const auto box_of = [this](std::span<const std::uint32_t> some) {
    Box box;
    for (const std::uint32_t i : some) box.include(points_[i]);
    return box;
  };
  tree_ = HalvedTree<Box>(std::move(items), 1, box_of, [this](std::uint32_t i) { return points_[i]; });
}

// No box is farther than its points: each step rounds a difference that is at most that of any of these, and rounding
// keeps order.
PointIndex::Found PointIndex::find(const Vec3& place) const {
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t number = 0;
  const auto distance = [&](const Box& box) { return box.squared_distance(place); };
  tree_.visit_nearest(distance, least, [&](std::uint32_t i) {
    const double here = squared_distance(place, points_[i]);
    if (here >= least) return;
    least = here;
    number = i;
  });
  return {std::sqrt(least), number};
}

}  // namespace affskel::core

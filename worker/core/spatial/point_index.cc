// A tree of its own beside BoxTree, which does not go to the nearest box first: 100,000 queries in 200,000
// points take 0.3 s here and 21 s there.
#include "core/spatial/point_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"

namespace affskel::core {
PointIndex::PointIndex(std::span<const Vec3> points) {
  if (points.size() > std::numeric_limits<std::uint32_t>::max()) {
    throw CoreError(CoreError::Code::kLimit, "too many points to index: " + std::to_string(points.size()));
  }
  points_.reserve(points.size());
  for (const Vec3& point : points) points_.push_back({point, static_cast<std::uint32_t>(points_.size())});
  if (!points_.empty()) build(0, static_cast<std::uint32_t>(points_.size()));
}

std::uint32_t PointIndex::build(std::uint32_t first, std::uint32_t count) {
  constexpr std::uint32_t kLeaf = 8;
  Box box;
  for (std::uint32_t i = first; i < first + count; ++i) box.include(points_[i].at);
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({box, first, count, 0});
  if (count <= kLeaf) return index;

  const int axis = static_cast<int>(box.longest_axis());
  const auto begin = points_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [axis](const Entry& a, const Entry& b) { return a.at[axis] < b.at[axis]; });
  build(first, count / 2);
  const std::uint32_t right = build(first + count / 2, count - count / 2);
  nodes_[index].right = right;
  return index;
}

PointIndex::Found PointIndex::find(const Vec3& place) const {
  double best = std::numeric_limits<double>::infinity();
  std::uint32_t number = 0;
  if (nodes_.empty()) return {best, number};
  // A lower bound of squared_distance to all points of the box that rounding cannot push above it: each step
  // rounds a difference that is at most the one of any point, and rounding keeps order.
  const auto bound = [&](std::uint32_t node) { return nodes_[node].box.squared_distance(place); };
  std::array<std::pair<double, std::uint32_t>, 64> stack;  // the tree is balanced: at most 32 levels
  std::size_t depth = 0;
  stack[depth++] = {bound(0), 0};
  while (depth > 0) {
    const auto [least, index] = stack[--depth];
    if (least >= best) continue;
    const Node& node = nodes_[index];
    if (node.right == 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const double here = squared_distance(place, points_[i].at);
        if (here >= best) continue;
        best = here;
        number = points_[i].number;
      }
      continue;
    }
    std::pair near = {bound(index + 1), index + 1}, far = {bound(node.right), node.right};
    if (far.first < near.first) std::swap(near, far);
    stack[depth++] = far;
    stack[depth++] = near;
  }
  return {std::sqrt(best), number};
}

}  // namespace affskel::core

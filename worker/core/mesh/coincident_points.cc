#include "core/mesh/coincident_points.h"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace affskel::core {

std::vector<std::uint32_t> first_coincident_point(std::span<const Vec3> points) {
  std::vector<std::uint32_t> order(points.size()), first(points.size());
  std::iota(order.begin(), order.end(), 0U);
  const auto place = [&](std::uint32_t i) { return std::tie(points[i].x, points[i].y, points[i].z); };
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return place(a) != place(b) ? place(a) < place(b) : a < b;
  });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool known = i > 0 && points[order[i]] == points[order[i - 1]];
    first[order[i]] = known ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace affskel::core

#include "core/curve/joint_sizes.h"

#include <algorithm>
#include <cstddef>

namespace affskel::core {

std::vector<double> joint_sizes(std::span<const Vec3> places,
                                std::span<const std::vector<std::uint32_t>> lines,
                                std::span<const double> ball) {
  std::vector<double> size(ball.begin(), ball.end());
  for (const auto& line : lines) {
    for (const bool from_last : {false, true}) {
      const auto at = [&](std::size_t n) { return line[from_last ? line.size() - 1 - n : n]; };
      double& largest = size[at(0)];
      for (std::size_t n = 1; n < line.size() && norm(places[at(n)] - places[at(0)]) < ball[at(n)]; ++n)
        largest = std::max(largest, ball[at(n)]);
    }
  }
  return size;
}

}  // namespace affskel::core

#include "core/infimum/near_places.h"

namespace affskel::core {
namespace {

constexpr std::size_t kOneStep = 6;

// The two steps to a place two steps away, in either order; twice the same on a straight line.
using Steps = std::array<std::uint8_t, 2>;

constexpr std::array<Steps, NearPlaces::kMost - kOneStep> all_steps() {
  std::array<Steps, NearPlaces::kMost - kOneStep> steps{};
  std::size_t count = 0;
  for (std::uint8_t i = 0; i < kOneStep; ++i) {
    for (std::uint8_t j = i; j < kOneStep; ++j) {
      if (i == j || i / 2 != j / 2) steps[count++] = {i, j};
    }
  }
  return steps;
}

constexpr auto kSteps = all_steps();

}  // namespace

NearPlaces::NearPlaces(const LatticeGrid& grid, const LatticeNeighbours& around,
                       const std::vector<LeastChord>& least, std::uint32_t point)
    : axes_(grid.axes), open_{} {
  for (std::size_t i = 0; i < kOneStep; ++i) point_[i] = around[point][i];
  for (std::size_t n = 0; n < kSteps.size(); ++n) {
    const auto [i, j] = kSteps[n];
    const std::uint32_t by_i = point_[i] != kNone ? around[point_[i]][j] : kNone;
    const std::uint32_t by_j = point_[j] != kNone ? around[point_[j]][i] : kNone;
    point_[kOneStep + n] = by_i != kNone ? by_i : by_j;
    open_[kOneStep + n] = {by_i != kNone, by_j != kNone};
  }
  for (std::size_t n = 0; n < kMost; ++n) erosion_[n] = point_[n] != kNone ? least[point_[n]].erosion : 0;
}

Vec3 NearPlaces::way(std::size_t place) const {
  const auto step = [&](std::size_t i) { return i % 2 == 0 ? axes_[i / 2] : -1 * axes_[i / 2]; };
  if (place < kOneStep) return step(place);
  const auto [i, j] = kSteps[place - kOneStep];
  return step(i) + step(j);
}

bool NearPlaces::holds_more(const Vec3& d, double erosion) const {
  std::array<double, kOneStep> height;
  for (std::size_t k = 0; k < 3; ++k) {
    height[2 * k] = dot(d, axes_[k]);
    height[2 * k + 1] = -height[2 * k];
  }
  for (std::size_t i = 0; i < kOneStep; ++i) {
    if (height[i] < 0 && erosion_[i] > erosion) return true;
  }
  for (std::size_t n = 0; n < kSteps.size(); ++n) {
    const auto [i, j] = kSteps[n];
    const std::size_t place = kOneStep + n;
    if (!(height[i] + height[j] < 0) || !(erosion_[place] > erosion)) continue;
    if ((open_[place][0] && height[i] < 0) || (open_[place][1] && height[j] < 0)) return true;
  }
  return false;
}

}  // namespace affskel::core

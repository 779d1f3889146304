#include "client/view/view_points.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace affskel::client {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kGridSteps = 65536;

}  // namespace

float view_divergence(double divergence) {
  const double size = std::fabs(divergence);
  const auto near = static_cast<float>(size);
  return double{near} < size ? std::nextafter(near, kInfinity) : near;
}

float view_share(double erosion, double volume) {
  const double share = erosion / volume;
  const auto near = static_cast<float>(share);
  return double{near} > share ? std::nextafter(near, -kInfinity) : near;
}

ViewGrid view_grid(const LatticePoints& lattice) {
  ViewGrid grid;
  grid.origin = lattice.origin();
  for (std::size_t a = 0; a < 3; ++a) {
    grid.lattice_steps[a] = (lattice.dims()[a] + kGridSteps - 1) / kGridSteps;
    grid.axes[a] = double(grid.lattice_steps[a]) * lattice.axis(static_cast<int>(a));
  }
  return grid;
}

ViewSelection select_view_points(const std::vector<float>& divergences, double threshold,
                                 std::uint64_t most) {
  constexpr double kShare = 0.1;  // of the threshold: below, nearly everything is a skeleton
  double lowest = kShare * threshold;
  if (divergences.size() > most) {
    std::vector<float> sorted = divergences;
    const auto first_left_out = sorted.begin() + static_cast<std::ptrdiff_t>(most);
    std::nth_element(sorted.begin(), first_left_out, sorted.end(), std::greater<>());
    lowest = std::clamp(double{*first_left_out}, lowest, threshold);
  }
  ViewSelection selection{static_cast<float>(lowest)};
  if (double{selection.lowest_threshold} > lowest)  // the conversion went up
    selection.lowest_threshold = std::nextafter(selection.lowest_threshold, 0.0f);
  return selection;
}

void ViewPointCollector::put(const FieldPoint& point) {
  const float divergence = divergences_.at(rank_);
  ++rank_;
  if (!(divergence > selection_.lowest_threshold)) return;
  ViewPoint kept;
  const std::array<std::uint32_t, 3> at = {point.i, point.j, point.k};
  for (std::size_t a = 0; a < 3; ++a) {
    kept.step[a] = static_cast<std::uint16_t>(at[a] / grid_.lattice_steps[a]);
  }
  kept.share = view_share(point.erosion, volume_);
  kept.slope = static_cast<float>(point.slope);
  kept.divergence = divergence;
  kept.inward = point.normal;
  points_.push_back(kept);
}

void ViewPointCollector::finish() {
  std::stable_sort(points_.begin(), points_.end(),
                   [](const ViewPoint& a, const ViewPoint& b) { return a.divergence > b.divergence; });
}

}  // namespace affskel::client

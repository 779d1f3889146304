#include "client/view/view_points.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace affskel::client {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kGridSteps = 65536;

// One point in `thinning` = 2^n: every 2^(n/3)-th along each axis, and of these all, those whose steps have
// an even sum (face-centred), or those whose steps are all even or all odd (body-centred).
bool on_sublattice(std::uint32_t thinning, std::uint32_t i, std::uint32_t j, std::uint32_t k) {
  std::uint32_t stride = 1;
  for (; thinning >= 8; thinning /= 8) stride *= 2;
  if (i % stride != 0 || j % stride != 0 || k % stride != 0) return false;
  const std::uint32_t a = i / stride % 2, b = j / stride % 2, c = k / stride % 2;
  if (thinning == 2) return (a + b + c) % 2 == 0;
  if (thinning == 4) return a == b && b == c;
  return true;
}

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

bool ViewSelection::keeps(float divergence, std::uint32_t i, std::uint32_t j, std::uint32_t k) const {
  return thinning == 1 || divergence > lowest_threshold || on_sublattice(thinning, i, j, k);
}

ViewSelection select_view_points(std::uint64_t points, const std::vector<float>& divergences,
                                 double threshold, std::uint64_t most) {
  ViewSelection selection;
  if (points <= most) return selection;
  std::uint64_t candidates = 0;
  if (!divergences.empty()) {
    std::vector<float> sorted = divergences;
    const auto first_left_out = sorted.begin() + static_cast<std::ptrdiff_t>(most / 2);
    std::nth_element(sorted.begin(), first_left_out, sorted.end(), std::greater<>());
    selection.lowest_threshold = static_cast<float>(std::min(double{*first_left_out}, threshold));
    if (double{selection.lowest_threshold} > threshold)  // the conversion went up
      selection.lowest_threshold = std::nextafter(selection.lowest_threshold, 0.0f);
    candidates = static_cast<std::uint64_t>(std::count_if(
        divergences.begin(), divergences.end(), [&](float h) { return h > selection.lowest_threshold; }));
  }
  const std::uint64_t room = std::max(most / 2, most - std::min(most, candidates));
  while ((points - candidates) / selection.thinning > room) selection.thinning *= 2;
  // Nothing to thin out after all: 1 would mean that everything is held, which is true.
  return selection;
}

void ViewPointCollector::put(const FieldPoint& point) {
  const float divergence = divergences_.empty() ? 0.0f : divergences_.at(rank_);
  ++rank_;
  if (!selection_.keeps(divergence, point.i, point.j, point.k)) return;
  ViewPoint kept;
  const std::array<std::uint32_t, 3> at = {point.i, point.j, point.k};
  for (std::size_t a = 0; a < 3; ++a) {
    kept.step[a] = static_cast<std::uint16_t>(at[a] / grid_.lattice_steps[a]);
  }
  kept.share = view_share(point.erosion, volume_);
  kept.divergence = divergence;
  kept.inward = point.normal;
  points_.push_back(kept);
}

void ViewPointCollector::finish() {
  std::stable_sort(points_.begin(), points_.end(),
                   [](const ViewPoint& a, const ViewPoint& b) { return a.divergence > b.divergence; });
}

}  // namespace affskel::client

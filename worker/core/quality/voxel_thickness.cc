// The shortest run is the one along the axis nearest to the sheet's normal: a digital plane has one voxel per
// line along its steepest axis.  Of t voxels across the sheet each counts as 1/t of a layer.
#include "core/quality/voxel_thickness.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

namespace affskel::core {
namespace {

class Thickness {
 public:
  explicit Thickness(std::span<const LatticePlace> voxels)
      : voxels_(voxels), order_(voxels.size()), least_(voxels.size(), kUnknown) {
    std::iota(order_.begin(), order_.end(), 0U);
  }

  double mean() {
    walk(0, 1, 2);  // lattice order
    walk(1, 2, 0);
    walk(2, 0, 1);
    // Counted first, so that the sum does not depend on the order of the voxels.
    double layer = 0;
    std::sort(least_.begin(), least_.end());
    for (std::size_t from = 0; from < least_.size();) {
      const auto to = std::upper_bound(least_.begin(), least_.end(), least_[from]) - least_.begin();
      layer += static_cast<double>(static_cast<std::size_t>(to) - from) / least_[from];
      from = static_cast<std::size_t>(to);
    }
    return static_cast<double>(least_.size()) / layer;
  }

 private:
  static constexpr std::uint32_t kUnknown = std::numeric_limits<std::uint32_t>::max();

  // Takes the runs along axis a, on lines (u, v).
  void walk(std::size_t u, std::size_t v, std::size_t a) {
    const auto key = [&](std::uint32_t p) { return std::tuple(voxels_[p][u], voxels_[p][v], voxels_[p][a]); };
    if (a != 2) {
      std::sort(order_.begin(), order_.end(),
                [&](std::uint32_t p, std::uint32_t q) { return key(p) < key(q); });
    }
    for (std::size_t from = 0; from < order_.size();) {
      std::size_t to = from + 1;
      while (to < order_.size() && follows(voxels_[order_[to - 1]], voxels_[order_[to]], a)) ++to;
      const auto length = static_cast<std::uint32_t>(to - from);
      for (; from < to; ++from) least_[order_[from]] = std::min(least_[order_[from]], length);
    }
  }

  static bool follows(const LatticePlace& p, LatticePlace q, std::size_t axis) {
    --q[axis];  // of 0: a place that no lattice reaches
    return p == q;
  }

  std::span<const LatticePlace> voxels_;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> least_;  // per voxel: the shortest run so far
};

}  // namespace

double mean_voxel_thickness(std::span<const LatticePlace> voxels) {
  return voxels.empty() ? 0 : Thickness(voxels).mean();
}

}  // namespace affskel::core

// Let x be the last sample point before the surface on a lattice line, y the next place, h their distance.  A
// contour by linear interpolation at the level v crosses the edge at the share t = (E(x) - v) / (E(x) -
// E(y)).
//
// Where the surface bulges, E falls to 0 like c a^n with the depth a of x: n = 1 at faces, 2 at smooth places
// and edges, 3 at corners (level_crossing.cc).  The tangent at x is below 0 at y, since a < h.  The contour
// of v = c b^n should lie a - b before x; it errs by nothing for n = 1, and by (a - b)^2 / (2 a) for n = 2,
// less than h / 4 for b > 0.3 h: for all levels but those within the last third of a step.
//
// Elsewhere E has a limit e > 0 at the surface, and jumps there to nothing.  No value of y puts the contours
// of all levels v < e at the surface.  With 0 they cross at t = 1 - v / e: always on the edge that the
// surface crosses, so that they are less than a step away from it, and on average over the levels in its
// middle, as the surface is over the edges.  A greater value would suit high levels better, and lets low ones
// run out beyond y.
//
// Measured against eroded_surface at 100,000 sample points: volumes at the levels 1, 3, 5 and 10 % of v0
// differ by +0.4, -0.5, -0.9 and +0.1 % of themselves on a body, in its affine frame by -0.1, -1.0, -1.4 and
// -0.6 %, on a torus by +1.6, +0.9, +0.5 and -0.5 %, and go with the step.  With 0.2 e in place of 0 by up
// to 3.7 %, and contours lie up to 1.6 steps away, not 0.9.  Further than two steps from places where E
// jumps, 99.9 % of a contour's points are less than h / 4 away, and all less than 0.3 h
// (tests/readers/vtk_test.py).
#include "core/erosion/outside_erosion.h"

#include <algorithm>
#include <utility>

namespace affskel::core {
namespace {

constexpr std::uint8_t kInside = 0xFF;

}  // namespace

OutsideErosion::OutsideErosion(const std::array<std::uint32_t, 3>& dims, Take take)
    : dims_{dims[0], dims[1], dims[2]}, take_(std::move(take)) {
  const auto size = static_cast<std::size_t>((dims_[1] + 2) * (dims_[2] + 2));
  for (Layer& layer : layers_) {
    layer.sum.assign(size, 0);
    layer.count.assign(size, 0);
  }
}

void OutsideErosion::put(const LatticePlace& at, double erosion, const Vec3& slopes) {
  const PlaceAround place = {at[0], at[1], at[2]};
  while (next_ < place[0] - 1) take_layer(next_++);
  Layer& own = layer(place[0]);
  own.count[in_layer(place[1], place[2])] = kInside;
  own.used = true;
  for (std::size_t a = 0; a < 3; ++a) {
    for (const int step : {-1, 1}) {
      PlaceAround next = place;
      next[a] += step;
      offer(next, erosion + step * slopes[static_cast<int>(a)]);
    }
  }
}

void OutsideErosion::offer(const PlaceAround& at, double tangent) {
  Layer& to = layer(at[0]);
  const std::size_t n = in_layer(at[1], at[2]);
  to.used = true;
  if (to.count[n] == kInside) return;
  to.sum[n] += std::min(0.0, tangent);
  ++to.count[n];
}

void OutsideErosion::take_layer(std::int64_t i) {
  Layer& taken = layer(i);
  if (!taken.used) return;
  for (std::int64_t j = -1; j <= dims_[1]; ++j) {
    for (std::int64_t k = -1; k <= dims_[2]; ++k) {
      const std::size_t n = in_layer(j, k);
      const std::uint8_t count = taken.count[n];
      if (count != 0 && count != kInside) take_({i, j, k}, taken.sum[n] / count);
    }
  }
  std::fill(taken.sum.begin(), taken.sum.end(), 0.0);
  std::fill(taken.count.begin(), taken.count.end(), std::uint8_t{0});
  taken.used = false;
}

void OutsideErosion::finish() {
  while (next_ <= dims_[0]) take_layer(next_++);
}

}  // namespace affskel::core

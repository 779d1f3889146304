#include "core/similarity.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/cube_root.h"
#include "core/error.h"
#include "core/lattice.h"
#include "core/point_index.h"

namespace affskel::core {
namespace {

// Axis-parallel box of half-sides h, centred at 0, covered by a lattice with these unit axes.
LatticeFrame covering_frame(const Vec3& h, const std::array<Vec3, 3>& axes, double step) {
  LatticeFrame frame;
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3& axis = axes[k];
    const double half = std::abs(axis.x) * h.x + std::abs(axis.y) * h.y + std::abs(axis.z) * h.z;
    frame.dims[k] = static_cast<std::uint32_t>(std::ceil(2 * half / step)) + 1;
    frame.axes[k] = step * axis;
    frame.origin = frame.origin - (0.5 * (frame.dims[k] - 1)) * frame.axes[k];
  }
  return frame;
}

}  // namespace

DistanceCurve::DistanceCurve(std::span<const Vec3> from, std::span<const Vec3> to) {
  if (from.empty() || to.empty()) {
    throw CoreError(CoreError::Code::kBadInput, "a set without points is near nothing");
  }
  const PointIndex index(to);
  distances_.reserve(from.size());
  for (const Vec3& p : from) distances_.push_back(index.nearest(p));
  std::sort(distances_.begin(), distances_.end());
}

double DistanceCurve::share_within(double radius) const {
  const auto beyond = std::upper_bound(distances_.begin(), distances_.end(), radius);
  return static_cast<double>(beyond - distances_.begin()) / static_cast<double>(distances_.size());
}

double DistanceCurve::area_under(double radius) const {
  double sum = 0;  // every point counts from its distance on
  for (const double d : distances_) sum += std::max(0.0, 1 - d / radius);
  return sum / static_cast<double>(distances_.size());
}

double DistanceCurve::area_under_squared(double radius) const {
  double sum = 0;
  for (const double d : distances_) sum += std::max(0.0, 1 - (d / radius) * (d / radius));
  return sum / static_cast<double>(distances_.size());
}

Similarity similarity(std::span<const Vec3> a, std::span<const Vec3> b) {
  return {DistanceCurve(a, b), DistanceCurve(b, a)};
}

std::vector<Vec3> inner_points(const Solid& solid, const InnerPointsOptions& options) {
  // A rotation by the quaternion 7 + i + 3j + 2k: rational, and in step with no axis-parallel plane for long.
  constexpr std::array<Vec3, 3> kAxes = {Vec3{37. / 63, -22. / 63, 46. / 63},
                                         Vec3{34. / 63, 53. / 63, -2. / 63},
                                         Vec3{-38. / 63, 26. / 63, 43. / 63}};
  const double scale = solid.scale();
  const double inner_volume = solid.volume / scale / scale / scale;
  const double step = cube_root(inner_volume / static_cast<double>(options.count));
  const Vec3 half = (0.5 / scale) * (solid.bbox_max - solid.bbox_min);
  const Lattice lattice = make_lattice(solid, covering_frame(half, kAxes, step));
  const SamplePlaces places(solid, lattice);
  std::vector<Vec3> points;
  points.reserve(lattice.points);
  for (const LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t i = 0; i < run.length; ++i) {
      points.push_back(places.at(run.start[0], run.start[1], run.start[2] + i));
    }
  }
  return points;
}

}  // namespace affskel::core

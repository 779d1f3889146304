#include "core/erosion/field_between.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "core/base/none.h"
#include "core/lattice/layer_index.h"

namespace affskel::core {
namespace {

// Indices that differ from a whole number by rounding alone are that number.
double snapped(double index) {
  constexpr double kRounding = 1e-9;
  const double whole = std::round(index);
  return std::abs(index - whole) < kRounding ? whole : index;
}

class Between {
 public:
  Between(const Lattice& lattice, const FrameField& field)
      : field_(field), ranks_(lattice), to_mesh_(inverse_transposed(frame_matrix(lattice))) {}

  /// The layer of sample points from which a place is seen; they come in ascending order.
  static std::int64_t layer_of(const Vec3& place) {
    return std::max<std::int64_t>(0, floor_of(snapped(place.x)));
  }

  void move_to(std::int64_t i) {
    while (next_layer_ <= i) ranks_.move_to(static_cast<std::uint32_t>(next_layer_++));
  }

  PlaceValue at(const Vec3& place) const {
    const Vec3 x{snapped(place.x), snapped(place.y), snapped(place.z)};
    const std::array<std::int64_t, 3> low = {floor_of(x.x), floor_of(x.y), floor_of(x.z)};
    double weights = 0, erosion = 0, area = 0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      const std::array<std::int64_t, 3> c = {low[0] + (corner >> 2), low[1] + ((corner >> 1) & 1),
                                             low[2] + (corner & 1)};
      const Vec3 to = x - vector_of(c);
      const double weight = (1 - std::abs(to.x)) * (1 - std::abs(to.y)) * (1 - std::abs(to.z));
      const std::uint32_t rank = ranks_.at(c[0], c[1], c[2]);
      if (weight == 0 || rank == kNone || !std::isfinite(field_.erosion[rank])) continue;
      weights += weight;
      erosion += weight * (field_.erosion[rank] + field_.spacing * dot(field_.gradient[rank], to));
      area += weight * norm(to_mesh_ * field_.gradient[rank]);
    }
    if (weights == 0)
      return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    return {std::max(0.0, erosion / weights), area / weights};
  }

 private:
  static std::int64_t floor_of(double index) { return static_cast<std::int64_t>(std::floor(index)); }

  const FrameField& field_;
  LayerIndex ranks_;
  Matrix3 to_mesh_;  // gradients of the frame as those of the mesh's coordinates
  std::int64_t next_layer_ = 0;
};

}  // namespace

std::vector<PlaceValue> field_between(const Lattice& lattice, const FrameField& field,
                                      std::span<const Vec3> places) {
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return Between::layer_of(places[a]) < Between::layer_of(places[b]);
  });
  Between between(lattice, field);
  std::vector<PlaceValue> values(places.size());
  for (const std::size_t n : order) {
    between.move_to(
        std::min<std::int64_t>(Between::layer_of(places[n]), std::int64_t{lattice.grid.dims[0]} - 1));
    values[n] = between.at(places[n]);
  }
  return values;
}

}  // namespace affskel::core

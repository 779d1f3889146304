#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/vec3.h"
#include "core/lattice/lattice_coordinates.h"

namespace affskel::core {

/// A lattice place that may lie one layer beyond the lattice: -1 to dims.
using PlaceAround = std::array<std::int64_t, 3>;

/// Continues E by one place beyond the solid, for programs that see a field as an image and know nothing of
/// the solid: contours of levels > 0 then close where the eroded solid ends.
///
/// A place outside next to sample points along an axis gets the mean over these of min(0, tangent), the
/// tangent being E + slope at the sample point: E goes on falling where the surface bulges, and is 0 where E
/// has a limit above 0 at the surface (saddles and hollows).  How near contours then are to the eroded solid:
/// outside_erosion.cc.
///
/// Holds three layers of the lattice.
class OutsideErosion {
 public:
  /// Takes the value of a place outside.  Called layer by layer, each in lattice order.
  using Take = std::function<void(const PlaceAround& at, double erosion)>;

  OutsideErosion(const std::array<std::uint32_t, 3>& dims, Take take);

  /// The next sample point, in lattice order.  Values of layer i are taken before the first of layer i + 2.
  /// @param slopes of E at the point for a step along each of the lattice's axes, by its gradient.
  void put(const LatticePlace& at, double erosion, const Vec3& slopes);

  /// Call once, last.
  void finish();

 private:
  struct Layer {
    std::vector<double> sum;
    std::vector<std::uint8_t> count;  // kInside for sample points
    bool used = false;
  };

  Layer& layer(std::int64_t i) { return layers_[static_cast<std::size_t>(i + 1) % 3]; }
  std::size_t in_layer(std::int64_t j, std::int64_t k) const {
    return static_cast<std::size_t>((j + 1) * (dims_[2] + 2) + (k + 1));
  }
  void offer(const PlaceAround& at, double tangent);
  void take_layer(std::int64_t i);

  PlaceAround dims_{};
  Take take_;
  std::array<Layer, 3> layers_;
  std::int64_t next_ = -1;  // the first layer that was not taken
};

}  // namespace affskel::core

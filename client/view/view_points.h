#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "client/artifacts/field_decoder.h"
#include "client/base/lattice_points.h"
#include "core/base/vec3.h"

namespace affskel::client {

/// A sample point as a page holds it.  Sliders compare |H| and E / v0 with floats.  |H| is rounded up to
/// float and E / v0 down, so that every such comparison gives what it gives with the double.
struct ViewPoint {
  std::array<std::uint16_t, 3> step{};  ///< place in the ViewGrid
  float share = 0;                      ///< E / v0
  float slope = 0;                      ///< of E: the section's area, mesh units squared
  float divergence = 0;                 ///< |H|, 0 without an operator that gives it
  core::Vec3 inward;                    ///< the optimal direction, unit
};

/// Steps of a lattice in 16 bits.  Only along an axis of more than 65536 steps does one step stand for
/// several of the lattice's.
struct ViewGrid {
  core::Vec3 origin;
  std::array<core::Vec3, 3> axes;
  std::array<std::uint32_t, 3> lattice_steps{};  ///< of the lattice, per step of the grid
};

/// |H|, rounded up to float.
float view_divergence(double divergence);

/// E / v0, rounded down to float.
float view_share(double erosion, double volume);

/// The grid in which a lattice's steps are stored.
ViewGrid view_grid(const LatticePoints& lattice);

/// Which points a page holds: those with |H| above a threshold, the lowest that its slider may take.
struct ViewSelection {
  float lowest_threshold = 0;
};

/// A tenth of the threshold at which the slider begins or, where that would leave more than `most` points,
/// what leaves `most`; but the skeleton at `threshold` is held whole.
/// @param divergences |H| of all points, as view_divergence.
ViewSelection select_view_points(const std::vector<float>& divergences, double threshold, std::uint64_t most);

/// Gathers a page's points from a field.
class ViewPointCollector : public FieldReceiver {
 public:
  /// All arguments must outlive it.  @param divergences as in select_view_points.
  ViewPointCollector(const ViewGrid& grid, const ViewSelection& selection,
                     const std::vector<float>& divergences, double volume, std::vector<ViewPoint>& points)
      : grid_(grid), selection_(selection), divergences_(divergences), volume_(volume), points_(points) {}

  void put(const FieldPoint& point) override;
  /// Sorts by descending |H|, equal ones in lattice order.
  void finish() override;

 private:
  const ViewGrid& grid_;
  const ViewSelection& selection_;
  const std::vector<float>& divergences_;
  double volume_;
  std::vector<ViewPoint>& points_;
  std::uint64_t rank_ = 0;
};

}  // namespace affskel::client

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/none.h"
#include "core/base/vec3.h"
#include "core/infimum/least_chord.h"
#include "core/lattice/lattice.h"

namespace affskel::core {

/// Per sample point the next ones within the solid, by axis, first the one with the greater index; kNone.
using LatticeNeighbours = std::vector<std::array<std::uint32_t, 6>>;

/// The sample points that are one or two lattice steps within the solid away from one, x.
class NearPlaces {
 public:
  static constexpr std::size_t kMost = 24;

  /// @param least what is known at all points.
  NearPlaces(const LatticeGrid& grid, const LatticeNeighbours& around, const std::vector<LeastChord>& least,
             std::uint32_t point);

  /// Calls visit(point, way from x) for each.
  template <class Visit>
  void for_each(Visit visit) const {
    for (std::size_t n = 0; n < kMost; ++n) {
      if (point_[n] != kNone) visit(point_[n], way(n));
    }
  }

  /// Whether the piece below the plane of normal d through x holds a near place of greater E, so that it is greater,
  /// too: all that is joined with y below the lower plane through y belongs to it.
  bool holds_more(const Vec3& d, double erosion) const;

 private:
  Vec3 way(std::size_t place) const;

  const std::array<Vec3, 3> axes_;
  std::array<std::uint32_t, kMost> point_;       // first those one step away, see kSteps in the source
  std::array<double, kMost> erosion_;            // there; 0 for kNone
  std::array<std::array<bool, 2>, kMost> open_;  // of two steps: whether one can go either way
};

}  // namespace affskel::core

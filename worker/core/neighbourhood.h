#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/directions.h"
#include "core/field.h"
#include "core/lattice.h"
#include "core/slab_index.h"

// The walk that all shock operators have in common.

namespace affskel::core {

/// The optimal normals round one sample point.  A neighbour outside the solid counts as the centre itself, so
/// that the solid's surface is no shock; a point without a direction has the normal 0.
class Neighbourhood {
 public:
  Neighbourhood(const DirectionSet& directions, const OptimalDirections& optimal, const SlabIndex& slabs,
                const std::array<std::int64_t, 3>& place, std::uint32_t point)
      : directions_(directions), optimal_(optimal), slabs_(slabs), place_(place), centre_(normal(point)) {}

  const Vec3& centre() const { return centre_; }

  /// The normal `step` lattice steps away, each -1, 0 or 1.
  Vec3 at(const std::array<int, 3>& step) const {
    const std::uint32_t p = slabs_.at(place_[0] + step[0], place_[1] + step[1], place_[2] + step[2]);
    return p == SlabIndex::kOutside ? centre_ : normal(p);
  }

  /// The normal `steps` (-1 or 1) lattice steps away along an axis.
  Vec3 along(int axis, int steps) const {
    std::array<int, 3> step{};
    step[static_cast<std::size_t>(axis)] = steps;
    return at(step);
  }

 private:
  Vec3 normal(std::uint32_t point) const {
    const std::uint32_t direction = optimal_[point];
    return direction == FieldValue::kNoDirection ? Vec3{} : directions_[direction];
  }

  const DirectionSet& directions_;
  const OptimalDirections& optimal_;
  const SlabIndex& slabs_;
  const std::array<std::int64_t, 3>& place_;
  Vec3 centre_;
};

/// `value(const Neighbourhood&)` at every sample point, in lattice order.
template <class Value>
std::vector<double> at_every_point(const Lattice& lattice, const DirectionSet& directions,
                                   const OptimalDirections& optimal, Value value) {
  std::vector<double> result(lattice.points, 0);
  SlabIndex slabs(lattice);
  std::uint32_t reached = SlabIndex::kOutside;
  for (const LatticeRun& run : lattice.axis[2].runs) {
    while (reached != run.start[0]) slabs.move_to(++reached);
    std::array<std::int64_t, 3> place{run.start[0], run.start[1], run.start[2]};
    for (std::uint32_t p = run.first; p < run.first + run.length; ++p, ++place[2]) {
      result[p] = value(Neighbourhood(directions, optimal, slabs, place, p));
    }
  }
  return result;
}

/// The sum over the axes of the differences between the planes of 9 before and behind; `weight` of a pair
/// across a face, an edge, a corner.
inline double weighted_plane_differences(const Neighbourhood& normals, const std::array<double, 3>& weight) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    double derivative = 0;
    for (int u = -1; u <= 1; ++u) {
      for (int v = -1; v <= 1; ++v) {
        std::array<int, 3> step{};
        step[static_cast<std::size_t>((a + 1) % 3)] = u;
        step[static_cast<std::size_t>((a + 2) % 3)] = v;
        step[static_cast<std::size_t>(a)] = 1;
        const double ahead = normals.at(step)[a];
        step[static_cast<std::size_t>(a)] = -1;
        const double behind = normals.at(step)[a];
        derivative += weight[static_cast<std::size_t>(u * u + v * v)] * (ahead - behind);
      }
    }
    sum += derivative;
  }
  return sum;
}

}  // namespace affskel::core

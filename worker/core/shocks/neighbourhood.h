#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/none.h"
#include "core/erosion/directions.h"
#include "core/erosion/field.h"
#include "core/lattice/lattice.h"
#include "core/lattice/layer_index.h"

// The walk that all shock operators have in common.

namespace affskel::core {

/// The optimal normals round one sample point.  A neighbour outside the solid counts as the centre itself, so
/// that the solid's surface is no shock (measured against other rules in shock_operator.cc); a point
/// without a direction has the normal 0.
///
/// Goes along the lattice's last axis: of the 27 normals 18 are the point's before, and looking one up costs
/// more than what an operator does with it.
class Neighbourhood {
 public:
  Neighbourhood(const DirectionSet& directions, const OptimalDirections& optimal, const LayerIndex& ranks)
      : directions_(directions), optimal_(optimal), ranks_(ranks) {}

  /// Moves to lattice place (i, j, k), a sample point.
  void start(std::int64_t i, std::int64_t j, std::int64_t k) {
    place_ = {i, j, k};
    for (int step : {-1, 0, 1}) look_up(step);
    collect();
  }

  /// Moves on to (i, j, k + 1), a sample point.
  void advance() {
    ++place_[2];
    look_up(1);
    collect();
  }

  const Vec3& centre() const { return *normals_[index({0, 0, 0})]; }

  /// The normal `step` lattice steps away, each -1, 0 or 1.
  const Vec3& at(const std::array<int, 3>& step) const { return *normals_[index(step)]; }

  /// The normal `steps` (-1 or 1) lattice steps away along an axis.
  const Vec3& along(int axis, int steps) const {
    std::array<int, 3> step{};
    step[static_cast<std::size_t>(axis)] = steps;
    return at(step);
  }

 private:
  struct Entry {
    Vec3 normal;
    bool inside = false;
  };
  using Layer = std::array<Entry, 9>;  // of equal k: 3 (i + 1) + j + 1
  static constexpr std::size_t kCentre = 4;

  static constexpr std::size_t index(const std::array<int, 3>& step) {
    return static_cast<std::size_t>(9 * (step[2] + 1) + 3 * (step[0] + 1) + step[1] + 1);
  }

  Layer& layer(int step) { return layers_[static_cast<std::size_t>(place_[2] + 1 + step) % 3]; }

  void look_up(int step) {
    Layer& to = layer(step);
    for (std::size_t e = 0; e < to.size(); ++e) {
      const std::uint32_t p = ranks_.at(place_[0] + static_cast<std::int64_t>(e / 3) - 1,
                                        place_[1] + static_cast<std::int64_t>(e % 3) - 1, place_[2] + step);
      to[e].inside = p != kNone;
      if (to[e].inside) to[e].normal = normal(p);
    }
  }

  void collect() {
    const Vec3& centre = layer(0)[kCentre].normal;
    std::size_t n = 0;
    for (int step : {-1, 0, 1}) {
      for (const Entry& entry : layer(step)) normals_[n++] = entry.inside ? &entry.normal : &centre;
    }
  }

  Vec3 normal(std::uint32_t point) const {
    const std::uint32_t direction = optimal_[point];
    return direction == FieldValue::kNoDirection ? Vec3{} : directions_[direction];
  }

  const DirectionSet& directions_;
  const OptimalDirections& optimal_;
  const LayerIndex& ranks_;
  std::array<std::int64_t, 3> place_{};
  std::array<Layer, 3> layers_;            // of k - 1, k and k + 1, each at (its k + 1) mod 3
  std::array<const Vec3*, 27> normals_{};  // in them, by index()
};

/// `value(const Neighbourhood&)` at every sample point, in lattice order.
/// @throws CoreError kCancelled when the context, if there is one, asks to stop: asked at every layer.
template <class Value>
std::vector<double> at_every_point(const Lattice& lattice, const DirectionSet& directions,
                                   const OptimalDirections& optimal, ExecutionContext* context, Value value) {
  std::vector<double> result(lattice.points, 0);
  LayerIndex ranks(lattice);
  std::uint32_t reached = kNone;
  Neighbourhood normals(directions, optimal, ranks);
  for (const LatticeRun& run : lattice.axis[2].runs) {
    for (; reached != run.start[0]; ranks.move_to(++reached)) throw_if_stopped(context);
    normals.start(run.start[0], run.start[1], run.start[2]);
    for (std::uint32_t p = run.first; p < run.first + run.length; ++p) {
      if (p != run.first) normals.advance();
      result[p] = value(normals);
    }
  }
  return result;
}

/// The difference along axis `a` between the planes of 9 before and behind.
template <int a>
double weighted_plane_difference(const Neighbourhood& normals, const std::array<double, 3>& weight) {
  double derivative = 0;
  for (int u = -1; u <= 1; ++u) {
    for (int v = -1; v <= 1; ++v) {
      std::array<int, 3> step{};
      step[(a + 1) % 3] = u;
      step[(a + 2) % 3] = v;
      step[a] = 1;
      const double ahead = normals.at(step)[a];
      step[a] = -1;
      const double behind = normals.at(step)[a];
      derivative += weight[static_cast<std::size_t>(u * u + v * v)] * (ahead - behind);
    }
  }
  return derivative;
}

/// The sum of these over the axes; `weight` of a pair across a face, an edge, a corner.
inline double weighted_plane_differences(const Neighbourhood& normals, const std::array<double, 3>& weight) {
  return (weighted_plane_difference<0>(normals, weight) + weighted_plane_difference<1>(normals, weight)) +
         weighted_plane_difference<2>(normals, weight);
}

}  // namespace affskel::core

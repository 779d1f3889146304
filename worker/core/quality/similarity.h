#pragma once

#include <span>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

/// How far the points of one set lie from another set: the curve r -> share of the points within r.  Exact,
/// for coordinates of any size.
class DistanceCurve {
 public:
  /// @param from, to not empty; a distance is that from a point of `from` to the nearest point of `to`.
  /// @throws CoreError kBadInput when a set is empty.
  DistanceCurve(std::span<const Vec3> from, std::span<const Vec3> to);

  /// Share of the points at a distance <= radius, 0 .. 1.
  double share_within(double radius) const;

  /// The integral of share_within from 0 to `radius`, divided by `radius`: 1 when every distance is 0.
  /// @param radius > 0
  double area_under(double radius) const;

  /// The same over the squared distance, from 0 to radius^2, divided by radius^2.
  double area_under_squared(double radius) const;

  /// The largest distance: the one-sided Hausdorff distance.
  double hausdorff() const { return distances_.back(); }

 private:
  std::vector<double> distances_;  // ascending
};

/// Similarity of two skeletons (Zografos 2003, sections 6.3 and 6.4, there in one direction and over the
/// squared distance): how much of each lies near the other.
struct Similarity {
  DistanceCurve a_in_b;  ///< of A's points from B
  DistanceCurve b_in_a;  ///< of B's points from A
};

/// @throws CoreError kBadInput when a set is empty.
Similarity similarity(std::span<const Vec3> a, std::span<const Vec3> b);

}  // namespace affskel::core

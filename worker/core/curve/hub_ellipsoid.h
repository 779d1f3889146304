#pragma once

#include <array>

#include "core/base/matrix3.h"
#include "core/base/vec3.h"
#include "core/curve/parted_lines.h"

namespace affskel::core {

/// As large as a body that limbs hang on.
struct HubEllipsoid {
  Vec3 centre;
  Matrix3 form{};  ///< (form * way) . way is 1 on the ellipsoid

  /// About how far a place is outside; within less than 0.
  double outside(const Vec3& at) const;

  /// Whether a place lies in it, outside() below 0.
  bool holds(const Vec3& at) const {
    const Vec3 way = at - centre;
    return dot(way, form * way) < 1;
  }

  /// Of sample points, each a cell of the lattice: with their moments, and a tenth larger, since what lies just outside is no
  /// limb's.
  /// @param spacing of the lattice.
  static HubEllipsoid of(const PlaceMoments& points, double spacing);

  /// Which share of an ellipsoid of their moments such points have: 1 of an ellipsoid, 0.89 of a box, little of a network of
  /// rods.
  double filled_by(const PlaceMoments& points, double spacing) const;

  /// Half its axes, the shortest first.
  std::array<double, 3> half_axes() const;

  /// Whether it is 2.25 times as long as wide.
  bool is_bar() const;
};

/// Of a ball that has as much of space as so many sample points.
double ball_radius(double points, double spacing);

}  // namespace affskel::core

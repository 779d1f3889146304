#pragma once

#include "core/base/matrix3.h"
#include "core/base/vec3.h"

namespace affskel::core {

/// The parabola through places at times t, by least squares.
class ParabolaFit {
 public:
  void add(double t, const Vec3& place) {
    const Vec3 powers{1, t, t * t};
    sums_ = sums_ + outer(powers, powers);
    places_ = places_ + outer(place, powers);
  }
  Vec3 at_0() const {
    const Vec3 row = inverse_transposed(sums_)[0];  // the sums are symmetric
    return row.x * places_[0] + row.y * places_[1] + row.z * places_[2];
  }

 private:
  Matrix3 sums_{}, places_{};
};

}  // namespace affskel::core

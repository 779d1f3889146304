#pragma once

#include <array>
#include <cmath>

#include "core/infimum/chord_piece.h"

namespace affskel::core {

/// Two coordinates of a plane's tilt, or a covector of them, see ChordPiece.
using Flat = std::array<double, 2>;

inline double dot(const Flat& a, const Flat& b) {
  return a[0] * b[0] + a[1] * b[1];
}
inline double cross(const Flat& a, const Flat& b) {
  return a[0] * b[1] - a[1] * b[0];
}
inline double norm(const Flat& a) {
  return std::sqrt(dot(a, a));
}

/// A piece with its second derivatives.
struct Stand : ChordPiece {
  Hessian hessian{};
};

/// A step of the tilt, and what the volume is to fall by to second order.
struct TiltStep {
  Flat t{};
  double gain = 0;
};

/// Newton's step, up to a longest one; where the volume is not convex its second derivative is raised until it is.
TiltStep free_step(const Stand& at);

/// Likewise along the great circle of a saddle.
/// @param z the saddle from x, along ChordPiece's u and w; not 0.
TiltStep step_round(const Stand& at, const Flat& z);

}  // namespace affskel::core

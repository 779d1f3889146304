#pragma once

#include <array>

#include "core/base/matrix3.h"
#include "core/solid/moments.h"

namespace affskel::core {

/// Orthonormal axes u, in no order and of either sign, and the kurtosis k = E[(u.w)^4] along each.
struct IndependentAxes {
  Matrix3 axes{};
  std::array<double, 3> kurtosis{};
};

/// The axes along which a whitened variable w (E[w] = 0, E[w w^T] = 1) is as far from a Gaussian as it gets:
/// they maximise the contrast sum (k - 3)^2 over all rotations (Comon 1994, "Independent component analysis,
/// a new concept?").  They turn with w.
///
/// Where symmetry leaves the axes open, the coordinate axes of w decide: see independent_axes.cc.
///
/// Uses +, -, *, / and sqrt only, so that all machines agree on every bit; about 10 ms.
IndependentAxes independent_axes(const FourthMoments& moments);

}  // namespace affskel::core

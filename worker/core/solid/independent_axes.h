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

/// The axes along which a whitened variable w (E[w] = 0, E[w w^T] = 1) is as far from a Gaussian, and thus as
/// near to independent, as it gets: they maximise the contrast sum (k - 3)^2 over all rotations (Comon 1994,
/// "Independent component analysis, a new concept?").  The contrast turns with w, and so do the axes.
///
/// The maximum is the largest of those that Newton steps reach from 343 rotations spread over all that differ
/// by more than order and signs.  Values that differ by less than 1e-6 of sum k^2 count as equal.  Of equal
/// maxima the rotation nearest to the coordinate axes is taken.  Where the contrast stays the same when the
/// axes turn about one line, they are turned so that the axis nearest to the plane across that line, and the
/// coordinate axis nearest to that plane, project onto it in the same direction.  Where it stays the same
/// about more lines than one, the result is the coordinate axes.
///
/// Uses +, -, *, / and sqrt only, so that all machines agree on every bit; about 10 ms.
IndependentAxes independent_axes(const FourthMoments& moments);

}  // namespace affskel::core

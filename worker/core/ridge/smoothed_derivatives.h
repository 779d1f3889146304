#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/matrix3.h"
#include "core/erosion/frame_field.h"
#include "core/lattice/lattice.h"
#include "core/ridge/ridge_constants.h"

namespace affskel::core {

// Notation.  P = sqrt(E / max E): near a smooth surface that bulges E grows with the square of the distance,
// so that P is nearly linear there.  Lengths in spacings.  d = E / |grad E| is the depth of a point.

/// The derivatives of P at a sample point.
struct PointDerivatives {
  float value = 0;                  ///< P itself, not smoothed
  float depth = 0;                  ///< local, spacings: see local_depth(); the Gaussian's width follows it
  std::array<float, 3> gradient{};  ///< per spacing
  std::array<float, 6> hessian{};   ///< xx, xy, xz, yy, yz, zz, per spacing squared
};

inline Matrix3 hessian_of(const PointDerivatives& point) {
  const auto h = [&](std::size_t n) { return static_cast<double>(point.hessian[n]); };
  return {Vec3{h(0), h(1), h(2)}, Vec3{h(1), h(3), h(4)}, Vec3{h(2), h(4), h(5)}};
}

/// First and second derivatives of P at every sample point by Gaussian derivatives (Lindeberg 1994; with the
/// moments of the sampled kernels made exact, so that quadratic polynomials have their own derivatives).
///
/// The width goes with the local depth, min over the points y that are reached within the solid of
/// d(y) + |x - y|: in a limb d is the length beyond the point, but never more than the way to a surface that
/// bulges.  So a finer lattice gives the same derivatives, and a scaled solid too.
///
/// Outside the solid P continues linearly from the nearest sample points by its exact gradient there, but
/// never below 0 nor above its value there.  Where the surface bulges that is 0, as E's definition says; at
/// saddles and hollows of the surface, where E is not 0, there is no false ridge a few spacings inside.
/// @param field of this lattice.
/// @param threads >= 1; the derivatives do not depend on it.
/// @return per sample point.  A function of lattice and field alone.
/// @param context asked at every step whether to stop.
/// @throws CoreError kCancelled when the context asks to stop.
std::vector<PointDerivatives> smoothed_derivatives(const Lattice& lattice, const FrameField& field,
                                                   unsigned threads = 1, ExecutionContext* context = nullptr,
                                                   const RidgeWidths& widths = {});

}  // namespace affskel::core

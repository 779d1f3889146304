// Between two sample points.  Where E is smooth: the root of the cubic through values and slopes.  Across a
// shock, where E is the minimum of two smooth functions: the root on the two tangents.  It is taken for a
// shock when the normals say so (`kinked`) and the tangents cross on the edge with a concave kink of more
// than half the sum of the slopes' sizes.  Both bounds are far above those of the operator `chords`, which is
// to miss no shock: at a weak one the cubic errs little, and where E is smooth it is by far the better.
// Across a jump, where chords begin to take in a limb more (E falls by more than 3/2 of what the steeper
// slope says): open between the roots of the tangents, in the middle.
//
// Before the surface, with tau = t / surface and p = -slope surface / E.  When the tangent falls to 0 before
// the surface (p >= 1), E is taken for E (1 - tau)^n (1 - f tau) with n + f = p, 0 <= f < 1: exact for faces
// (p = 1), smooth convex surfaces and convex edges (2) and corners (3).  Otherwise, at concave places, E has
// a limit > 0 at the surface and is taken for its tangent; when that is above the level at the surface, the
// surface itself bounds the eroded solid.
#include "core/surface/level_crossing.h"

#include <algorithm>
#include <cmath>

namespace affskel::core {
namespace {

/// Where a continuous function, >= 0 at 0, changes sign in [0, 1].  Bisection needs no more than that, and
/// halving a share is exact: 50 steps give all the digits a coordinate can keep.
template <class Function>
double root(Function f) {
  double low = 0, step = 1;
  for (int i = 0; i < 50; ++i) {
    step /= 2;
    if (f(low + step) >= 0) low += step;
  }
  return low;
}

/// The concave kink of the two tangents, when there is one: writes its place on the edge.
bool find_kink(const EdgeValue& x, const EdgeValue& y, double& t) {
  constexpr double kMinStrength = 0.5;
  if (!(tangents_kink(x, y) > kMinStrength * (std::abs(x.slope) + std::abs(y.slope)))) return false;
  t = tangents_crossing(x, y);
  return t >= 0 && t <= 1;
}

/// Whether E falls faster than either end says.
bool jumps(const EdgeValue& x, const EdgeValue& y) {
  constexpr double kMaxFall = 1.5;
  return x.erosion - y.erosion > kMaxFall * std::max({-x.slope, -y.slope, 0.0});
}

/// Above the level as far as the tangent at x says, below it as far as the one at y says.
LevelCrossing across_jump(const EdgeValue& x, const EdgeValue& y, double level) {
  const double most = x.slope < 0 ? std::min((level - x.erosion) / x.slope, 1.0) : 1;
  const double least = y.slope < 0 ? std::max(1 + (level - y.erosion) / y.slope, 0.0) : 0;
  return {(least + most) / 2, std::min(least, most), std::max(least, most)};
}

double across_kink(const EdgeValue& x, const EdgeValue& y, double level, double kink) {
  const double t =
      x.erosion + kink * x.slope >= level ? 1 + (level - y.erosion) / y.slope : (level - x.erosion) / x.slope;
  return std::clamp(t, 0.0, 1.0);
}

/// Root of the cubic a + t (b + t (c + t d)).
double across_smooth(const EdgeValue& x, const EdgeValue& y, double level) {
  const double a = x.erosion - level, b = x.slope, fall = y.erosion - x.erosion;
  const double c = 3 * fall - 2 * b - y.slope, d = b + y.slope - 2 * fall;
  return root([&](double t) { return a + t * (b + t * (c + t * d)); });
}

}  // namespace

LevelCrossing level_crossing_between(const EdgeValue& above, const EdgeValue& below, double level,
                                     bool kinked) {
  if (!std::isfinite(above.erosion) || !std::isfinite(below.erosion)) return {0.5, 0, 1};
  if (jumps(above, below)) return across_jump(above, below, level);
  double kink = 0;
  const double t = kinked && find_kink(above, below, kink) ? across_kink(above, below, level, kink)
                                                           : across_smooth(above, below, level);
  return {t, t, t};
}

double level_crossing_before_surface(const EdgeValue& above, double surface, double level) {
  if (!std::isfinite(above.erosion) || !(above.slope < 0) || !(above.erosion > 0)) return surface;
  const double power = -above.slope * surface / above.erosion;
  if (power < 1) return std::min(surface, (above.erosion - level) / -above.slope);
  // More than 8 means that E is far from any power law; the steepest curve will do.
  constexpr double kMaxFactors = 8;
  const double factors = std::min(std::floor(power), kMaxFactors);
  const double rest = std::min(power - factors, 1.0), wanted = level / above.erosion;
  return surface * root([&](double tau) {
           double product = 1 - rest * tau;
           for (double n = 0; n < factors; ++n) product *= 1 - tau;
           return product - wanted;
         });
}

}  // namespace affskel::core

#include "core/level_crossing.h"

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
  constexpr double kLeastStrength = 0.5;
  const double strength = x.slope - y.slope;
  if (!(strength > kLeastStrength * (std::abs(x.slope) + std::abs(y.slope)))) return false;
  t = (y.erosion - x.erosion - y.slope) / strength;
  return t >= 0 && t <= 1;
}

}  // namespace

double level_crossing_between(const EdgeValue& above, const EdgeValue& below, double level, bool kinked) {
  if (!std::isfinite(above.erosion) || !std::isfinite(below.erosion)) return 0.5;
  double kink = 0;
  if (kinked && find_kink(above, below, kink)) {
    const double t = above.erosion + kink * above.slope >= level ? 1 + (level - below.erosion) / below.slope
                                                                 : (level - above.erosion) / above.slope;
    return std::clamp(t, 0.0, 1.0);
  }
  // The cubic a + t (b + t (c + t d)).
  const double a = above.erosion - level, b = above.slope, fall = below.erosion - above.erosion;
  const double c = 3 * fall - 2 * b - below.slope, d = b + below.slope - 2 * fall;
  return root([&](double t) { return a + t * (b + t * (c + t * d)); });
}

double level_crossing_before_surface(const EdgeValue& above, double surface, double level) {
  if (!std::isfinite(above.erosion) || !(above.slope < 0) || !(above.erosion > 0)) return surface;
  const double power = -above.slope * surface / above.erosion;
  if (power < 1) return std::min(surface, (above.erosion - level) / -above.slope);
  // More than 8 means that E is far from any power law; the steepest curve will do.
  constexpr double kMostFactors = 8;
  const double factors = std::min(std::floor(power), kMostFactors);
  const double rest = std::min(power - factors, 1.0), wanted = level / above.erosion;
  return surface * root([&](double tau) {
           double product = 1 - rest * tau;
           for (double n = 0; n < factors; ++n) product *= 1 - tau;
           return product - wanted;
         });
}

}  // namespace affskel::core

#include "core/base/plain_math.h"

#include <cmath>
#include <numbers>

namespace affskel::core {

double plain_log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);  // exact; m in [1/2, 1)
  if (m < std::numbers::sqrt2 / 2) {
    m *= 2;
    --exponent;
  }
  // log m = 2 artanh s; |s| < 0.172, so the first term left out is below 1e-18.
  const double s = (m - 1) / (m + 1), square = s * s;
  double sum = 0;
  for (int k = 21; k >= 1; k -= 2) sum = sum * square + 1.0 / k;
  return 2 * s * sum + exponent * std::numbers::ln2;
}

std::pair<double, double> plain_sin_cos_degrees(double degrees) {
  const double turned = std::fmod(degrees, 360);  // exact
  const double quarters = std::round(turned / 90);
  const double x =
      (turned - 90 * quarters) * (std::numbers::pi / 180);  // |x| <= pi / 4; the difference exact
  // Taylor's series up to x^18: the first terms left out are below 1e-19.
  const double square = x * x;
  double sine = 1, cosine = 1;
  for (int k = 8; k >= 1; --k) {
    sine = 1 - square / ((2 * k) * (2 * k + 1)) * sine;
    cosine = 1 - square / ((2 * k - 1) * (2 * k)) * cosine;
  }
  sine *= x;
  switch ((static_cast<int>(quarters) + 4) % 4) {
    case 0:
      return {sine, cosine};
    case 1:
      return {cosine, -sine};
    case 2:
      return {-sine, -cosine};
    default:
      return {-cosine, sine};
  }
}

}  // namespace affskel::core

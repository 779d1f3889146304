#include "core/base/plain_math.h"

#include <cmath>
#include <numbers>

#include "core/base/double_sum.h"

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

double plain_exp(double x) {
  // Horner's scheme, 1 + x (1 + x / 2 (1 + x / 3 (...))), in two doubles; what is left out is below 1e-25.
  DoubleSum sum{1, 0};
  for (int k = 24; k >= 1; --k) {
    const DoubleSum inverse = quotient(1, 1, k), scaled = times(sum, x);
    DoubleSum term = product(scaled.hi, inverse.hi);
    term.lo += scaled.hi * inverse.lo + scaled.lo * inverse.hi;
    sum = {1, 0};
    sum.add(term);
  }
  return sum.value();
}

double cube_root(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  for (; exponent % 3 != 0; ++exponent) m /= 2;
  double y = 1;  // 1/8 <= m < 1: seven steps are enough
  for (int i = 0; i < 10; ++i) y -= (y - m / (y * y)) / 3;
  return std::ldexp(y, exponent / 3);
}

double plain_angle(double y, double x) {
  const double width = std::abs(x);
  if (y == 0 && width == 0) return 0;
  const bool steep = y > width;
  double t = steep ? width / y : y / width;
  // atan t = 2 atan(t / (1 + sqrt(1 + t^2))), twice: t < 0.2, so the first term left out is below 1e-19.
  for (int halving = 0; halving < 2; ++halving) t /= 1 + std::sqrt(1 + t * t);
  const double square = t * t;
  double sum = 0;
  for (int k = 25; k >= 1; k -= 2) sum = 1.0 / k - sum * square;
  const double shallow = 4 * t * sum;
  const double angle = steep ? std::numbers::pi / 2 - shallow : shallow;
  return x < 0 ? std::numbers::pi - angle : angle;
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

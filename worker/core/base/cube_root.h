#pragma once

#include <cmath>

namespace affskel::core {

/// The cube root of a finite x > 0, to an ulp or two and the same on all machines: std::cbrt rounds
/// differently from one libm to the next.  Newton's iteration.
inline double cube_root(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  for (; exponent % 3 != 0; ++exponent) m /= 2;
  double y = 1;  // 1/8 <= m < 1: seven steps are enough
  for (int i = 0; i < 10; ++i) y -= (y - m / (y * y)) / 3;
  return std::ldexp(y, exponent / 3);
}

}  // namespace affskel::core

#pragma once

#include <utility>

namespace affskel::core {

// Functions of the mathematical library whose last digit differs between machines, from + - * / alone, so
// that what is stored does not.

/// Natural logarithm of a normal double > 0, to about 1e-15 of the larger of 1 and itself.
double plain_log(double x);

/// (sin, cos) of a finite angle in degrees, to about 1e-16; exactly 0, 1 and -1 at the multiples of 90.
std::pair<double, double> plain_sin_cos_degrees(double degrees);

}  // namespace affskel::core

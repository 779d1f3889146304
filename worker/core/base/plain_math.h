#pragma once

#include <utility>

namespace affskel::core {

// Functions whose last digit differs from one mathematical library to the next, from + - * / and sqrt alone.
// To be used wherever the result is stored, lays a lattice or decides a sign.

/// Natural logarithm of a normal double > 0, to about 1e-15 of the larger of 1 and itself.
double plain_log(double x);

/// e^x for |x| <= 1, rounded to nearest unless e^x lies within 1e-10 ulp of the midpoint of two doubles.
double plain_exp(double x);

/// The cube root of a finite x > 0, to an ulp or two and the same on all machines: std::cbrt rounds
/// differently from one libm to the next.  Newton's iteration.
double cube_root(double x);

/// The angle from the x axis to (x, y), y >= 0: 0 .. pi, radians, to about 1e-15; 0 for (0, 0).
double plain_angle(double y, double x);

/// (sin, cos) of a finite angle in degrees, to about 1e-16; exactly 0, 1 and -1 at the multiples of 90.
std::pair<double, double> plain_sin_cos_degrees(double degrees);

}  // namespace affskel::core

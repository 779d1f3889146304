#pragma once

#include <cmath>

namespace affskel::core {

/// A number kept as an unevaluated sum of two doubles: about 104 bits, so that huge terms cancel and leave
/// the small ones intact (Knuth's two-sum, Dekker 1971).
struct DoubleSum {
  double hi = 0, lo = 0;

  void add(double value, double low = 0) {
    const double sum = hi + value, rounded = sum - hi;
    lo += ((hi - (sum - rounded)) + (value - rounded)) + low;
    hi = sum;
  }
  void add(const DoubleSum& other) { add(other.hi, other.lo); }
  double value() const { return hi + lo; }
};

/// num / (a b); the arguments are taken as exact.
inline DoubleSum quotient(double num, double a, double b) {
  const double product = a * b, product_low = std::fma(a, b, -product);
  const double hi = num / product;
  return {hi, (std::fma(-hi, product, num) - hi * product_low) / product};
}

inline DoubleSum times(const DoubleSum& s, double factor) {
  const double hi = s.hi * factor;
  return {hi, std::fma(s.hi, factor, -hi) + s.lo * factor};
}

}  // namespace affskel::core

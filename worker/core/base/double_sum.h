#pragma once

namespace affskel::core {

/// A number kept as an unevaluated sum of two doubles: about 104 bits, so that huge terms cancel and leave
/// the small ones intact (Knuth's two-sum, Dekker 1971).  The core's one compensated sum.
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

/// a * b as two doubles, exactly unless they over- or underflow (Dekker 1971).  Without std::fma, which is a
/// call where the processor may lack the instruction.
inline DoubleSum product(double a, double b) {
  constexpr double kSplitter = 134217729;  // 2^27 + 1
  const double wide_a = kSplitter * a, wide_b = kSplitter * b;
  const double a_hi = wide_a - (wide_a - a), b_hi = wide_b - (wide_b - b);
  const double a_lo = a - a_hi, b_lo = b - b_hi;
  const double p = a * b;
  return {p, ((a_hi * b_hi - p) + (a_hi * b_lo + a_lo * b_hi)) + a_lo * b_lo};
}

/// num / (a b); the arguments are taken as exact.
inline DoubleSum quotient(double num, double a, double b) {
  const DoubleSum divisor = product(a, b);
  const double hi = num / divisor.hi;
  const DoubleSum back = product(hi, divisor.hi);
  return {hi, (((num - back.hi) - back.lo) - hi * divisor.lo) / divisor.hi};
}

inline DoubleSum times(const DoubleSum& s, double factor) {
  const DoubleSum hi = product(s.hi, factor);
  return {hi.hi, hi.lo + s.lo * factor};
}

}  // namespace affskel::core

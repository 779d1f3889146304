#pragma once

#include <optional>
#include <span>
#include <utility>

namespace affskel::bench {

/// The exponent e of y = c x^e that fits the points (x, y) best, by least squares of the logarithms;
/// nothing when fewer than two different x are given.  All x and y must be > 0.
std::optional<double> growth_exponent(std::span<const std::pair<double, double>> points);

}  // namespace affskel::bench

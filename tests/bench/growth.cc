#include "growth.h"

#include <cmath>

namespace affskel::bench {

std::optional<double> growth_exponent(std::span<const std::pair<double, double>> points) {
  const double n = static_cast<double>(points.size());
  double mean_x = 0, mean_y = 0;
  for (const auto& [x, y] : points) {
    mean_x += std::log(x) / n;
    mean_y += std::log(y) / n;
  }
  double xx = 0, xy = 0;
  for (const auto& [x, y] : points) {
    xx += (std::log(x) - mean_x) * (std::log(x) - mean_x);
    xy += (std::log(x) - mean_x) * (std::log(y) - mean_y);
  }
  if (xx <= 0) return std::nullopt;
  return xy / xx;
}

}  // namespace affskel::bench

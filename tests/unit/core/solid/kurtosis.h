#pragma once

#include <array>
#include <cstddef>

#include "core/solid/moments.h"

namespace affskel::core {

/// E[(u.w)^4] of the fourth moments of w.
inline double kurtosis_along(const FourthMoments& m, const Vec3& u) {
  const std::array<double, 3> c = {u.x, u.y, u.z};
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) sum += c[i] * c[j] * dot(u, m[i][j] * u);
  }
  return sum;
}

}  // namespace affskel::core

#pragma once

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

/// Threshold for |H|, per mesh unit: 0.57 / spacing, which keeps the same jumps as Zucker-Hummel's 7.
///
/// The published rule is alpha / spacing with alpha "of the order of unity" (Betelu et al. 2001).  At a sheet
/// parallel to two axes where the normal component across jumps by J <= 2, |H| = J / (2 spacing): alpha = 1
/// would keep no point of it even where the normals are opposite.  0.57 stands for the jump that
/// Zucker-Hummel's 7 does, J = 1.14.
inline double central_difference_threshold(double spacing) {
  return 0.57 / spacing;
}

/// H = div n by central differences: the derivative along a lattice axis is (n(x + e) - n(x - e)) /
/// (2 spacing) (Zografos 2003, section 3.2.2).  A sheet shows on both sides.  Per mesh unit; |H| <= 3 / spacing.
inline double central_difference_divergence(const Neighbourhood& normals, double spacing) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += normals.along(a, 1)[a] - normals.along(a, -1)[a];
  return sum / (2 * spacing);
}

}  // namespace affskel::core

#pragma once

#include "core/shocks/neighbourhood.h"

namespace affskel::core {

/// Threshold for |H|, per mesh unit: alpha / spacing with alpha = 1 (Betelu et al. 2001: "of the order of
/// unity"; Zografos 2003, sections 3.2.2 and 6.2.2: appropriate with this operator).  At a sheet parallel to
/// two axes alpha is the jump J of the normal component across it; Zucker-Hummel's 7 stands for J = 1.14.
inline double intermediate_difference_threshold(double spacing) {
  return 1 / spacing;
}

/// H = div n by intermediate differences: the derivative along a lattice axis is (n(x + e) - n(x)) / spacing
/// (Betelu et al. 2001; Zografos 2003, section 3.2.2).  A sheet shows on its lower side only, one point thick.
/// Per mesh unit; |H| <= 3 * 2 / spacing.
inline double intermediate_difference_divergence(const Neighbourhood& normals, double spacing) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) sum += normals.along(a, 1)[a] - normals.centre()[a];
  return sum / spacing;
}

}  // namespace affskel::core

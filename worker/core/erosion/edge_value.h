#pragma once

namespace affskel::core {

/// What is known of E at an end of a lattice edge: its value and its derivative along the edge, g.delta, per
/// length of the edge (exact, see FrameField).  At both ends in the same sense along the edge.
struct EdgeValue {
  double erosion = 0;
  double slope = 0;
};

/// The kink s = (g_x - g_y).delta of the tangents at the ends x and y of an edge with delta = y - x: > 0
/// where the lower of the two is concave, as E is at a shock.
inline double tangents_kink(const EdgeValue& x, const EdgeValue& y) {
  return x.slope - y.slope;
}

/// Where the tangents are equal, as a share of the way from x to y: t = (E_y - E_x - g_y.delta) / s.  It may
/// lie outside [0, 1]; not finite for tangents without a kink.
inline double tangents_crossing(const EdgeValue& x, const EdgeValue& y) {
  return (y.erosion - x.erosion - y.slope) / tangents_kink(x, y);
}

}  // namespace affskel::core

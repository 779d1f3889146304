#pragma once

#include "core/erosion/edge_value.h"

namespace affskel::core {

/// A place on an edge as a share in [0, 1] of the way from the end above the level, and the bounds between
/// which the data leave it open: all three equal where E is continuous.
struct LevelCrossing {
  double share = 0;
  double min_share = 0, max_share = 0;
};

/// Where E falls to `level` between two sample points with no surface between them, from `above`
/// (E >= level) to `below` (E < level); slopes in the sense from `above` to `below`.
///
/// E is piecewise smooth.  Where it is smooth: the root of the cubic through values and slopes, error of
/// order 4 in the spacing.  Across a shock, where E is the minimum of two smooth functions: the root on the
/// two tangents, error of order 2.  It is taken for one when the caller says so (`kinked`: the normals at the
/// two ends differ by more than 60 degrees) and the tangents cross on the edge with a concave kink that is
/// more than half the sum of the slopes' sizes.  Both bounds are far above those of operator `chords`, which
/// is to miss no shock: at a weak one the cubic errs little, and where E is smooth it is by far the better.
/// Across a jump, where chords begin to take in a limb more (E falls by more than 3/2 of what the steeper
/// slope says): open between the roots of the tangents, in the middle.  A value that is not finite leaves all
/// open.
LevelCrossing level_crossing_between(const EdgeValue& above, const EdgeValue& below, double level,
                                     bool kinked);

/// Where E falls to `level` on an edge from `above` that meets the surface at the share `surface` of its
/// length, before it meets another sample point; at most `surface`.
///
/// With tau = t / surface and p = -slope surface / E, E is taken for E (1 - tau)^n (1 - f tau) with
/// n + f = p, 0 <= f < 1, when the tangent falls to 0 before the surface (p >= 1): exact for faces (p = 1),
/// smooth convex parts and convex edges (2) and corners (3).  Otherwise, at concave parts, where E has a
/// limit > 0 at the surface, for its tangent; when that is above the level at the surface, the surface
/// itself bounds the eroded solid.
double level_crossing_before_surface(const EdgeValue& above, double surface, double level);

}  // namespace affskel::core

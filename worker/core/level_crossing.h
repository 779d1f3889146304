#pragma once

namespace affskel::core {

/// What is known of E at an end of a lattice edge: its value and its derivative along the edge, in the sense
/// from the end above the level to the other one, per length of the edge (exact, see FrameField).
struct EdgeValue {
  double erosion = 0;
  double slope = 0;
};

/// A place on an edge as a share in [0, 1] of the way from the end above the level, and the bounds between
/// which the data leave it open: all three equal where E is continuous.
struct LevelCrossing {
  double share = 0;
  double least = 0, most = 0;
};

/// Where E falls to `level` between two sample points with no surface between them, from `above`
/// (E >= level) to `below` (E < level).
///
/// E is piecewise smooth.  Within a piece: the root of the cubic through values and slopes, error of order 4
/// in the spacing.  Across a shock, where E is the minimum of two smooth functions (`kinked`, and the two
/// tangents cross on the edge with a concave kink that is strong against the slopes: strength > 1/2, see
/// operator `chords`): the root on the two tangents, error of order 2.  Across a jump, where a chordal piece
/// begins to take in another part of the solid (E falls by more than 3/2 of what the steeper slope says):
/// open between the roots of the tangents, in the middle.  A value that is not finite leaves all open.
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

#pragma once

#include "core/erosion/edge_value.h"

namespace affskel::core {

/// A place on an edge, as a share in [0, 1] of the way from the end above the level, and the interval in
/// which the data leave it open: all three are equal where E is continuous.
struct LevelCrossing {
  double share = 0;
  double min_share = 0, max_share = 0;
};

/// Where E falls to `level` between two sample points with no surface between them, from `above` (E >= level)
/// to `below` (E < level); slopes in the sense from `above` to `below`.  Error of order 4 in the spacing
/// where E is smooth, of order 2 across a shock; across a jump of E an interval.  A value that is not finite
/// leaves the whole edge open.
/// @param kinked whether the normals at the two ends differ by more than 60 degrees.
LevelCrossing level_crossing_between(const EdgeValue& above, const EdgeValue& below, double level,
                                     bool kinked);

/// Where E falls to `level` on an edge from `above` that meets the surface at the share `surface` of its
/// length, before it meets another sample point; at most `surface`.  Exact near faces, smooth convex
/// surfaces, and convex edges and corners.
double level_crossing_before_surface(const EdgeValue& above, double surface, double level);

}  // namespace affskel::core

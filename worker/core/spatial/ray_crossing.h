#pragma once

#include <algorithm>
#include <cstddef>

#include "core/mesh/mesh.h"

// Rays parallel to an axis against triangles.  Seen along the axis, a triangle is a polygon in (u, v),
// u = (axis + 1) % 3, v = (axis + 2) % 3.

namespace affskel::core {

/// How often the triangle's outline winds round the ray's line, seen against the ray: 1, 0 or -1.  An edge
/// crosses the half-line from q towards +u when exactly one end has v <= q.v (ends compared exactly) and it
/// does so beyond q.u; that is decided the same way for both triangles of the edge, so that a line that meets
/// an edge or a vertex of a closed surface is still counted rightly.
inline int winding_round_line(const Mesh& mesh, const Triangle& t, const Vec3& q, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  int winding = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 &a = mesh.points[t[i]], &b = mesh.points[t[(i + 1) % 3]];
    if ((a[v] <= q[v]) == (b[v] <= q[v])) continue;
    const bool up = a[v] < b[v];
    const Vec3 &low = up ? a : b, &high = up ? b : a;
    const double at = low[u] + (q[v] - low[v]) / (high[v] - low[v]) * (high[u] - low[u]);
    // Never beyond the triangle's box, whatever the rounding.
    if (std::clamp(at, std::min(low[u], high[u]), std::max(low[u], high[u])) > q[u]) winding += up ? 1 : -1;
  }
  return winding;
}

/// How far along the axis the triangle's plane is from q; for a triangle parallel to the axis its first
/// corner.
inline double distance_along(const Mesh& mesh, const Triangle& t, const Vec3& q, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const Vec3 &a = mesh.points[t[0]], n = twice_area(mesh, t);
  if (n[axis] == 0) return a[axis] - q[axis];
  return a[axis] - ((q[u] - a[u]) * n[u] + (q[v] - a[v]) * n[v]) / n[axis] - q[axis];
}

}  // namespace affskel::core

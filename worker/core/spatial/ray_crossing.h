#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>

#include "core/mesh/mesh.h"

// Rays against triangles, most of them parallel to an axis.  Seen along the axis, a triangle is a polygon in (u, v),
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

/// Where a triangle, with its border, crosses a line in any direction.
/// @return the part of `way` from there to it, of either sign; none where the line runs along it, or beside it.
inline std::optional<double> crossing_along(const Mesh& mesh, const Triangle& t, const Vec3& from,
                                            const Vec3& way) {
  const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
  const Vec3 out = cross(b - a, c - a);
  const double steep = dot(out, way);
  if (steep == 0) return std::nullopt;
  const double part = dot(out, a - from) / steep;
  const Vec3 at = from + part * way;
  const auto is_left = [&](const Vec3& p, const Vec3& q) { return dot(cross(q - p, at - p), out) >= 0; };
  if (!is_left(a, b) || !is_left(b, c) || !is_left(c, a)) return std::nullopt;
  return part;
}

}  // namespace affskel::core

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>

#include "core/base/basis.h"
#include "core/base/unit.h"
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

/// A line in any direction, against triangles.  Seen along it, each is a polygon about the line or not, by the same rule as
/// in winding_round_line(): of a closed surface nothing is missed, and nothing crossed twice, at edges and vertices.
class CrossedLine {
 public:
  /// @param way of any length > 0.
  CrossedLine(const Vec3& from, const Vec3& way)
      : from_(from), way_(way), u_(unit_beside(unit(way))), v_(unit(cross(way, u_))) {}

  struct Crossing {
    double part;  ///< of the way from where the line begins, of either sign
    int leaves;   ///< 1 where the way leads out through the triangle, -1 where it leads in
  };

  std::optional<Crossing> with(const Mesh& mesh, const Triangle& t) const {
    struct Seen {
      double x, y;
    };
    std::array<Seen, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 to = mesh.points[t[k]] - from_;
      corners[k] = {dot(to, u_), dot(to, v_)};
    }
    int leaves = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const Seen &a = corners[k], &b = corners[(k + 1) % 3];
      if ((a.y <= 0) == (b.y <= 0)) continue;
      const bool up = a.y < b.y;
      const Seen &low = up ? a : b, &high = up ? b : a;
      if (low.x - low.y / (high.y - low.y) * (high.x - low.x) > 0) leaves += up ? 1 : -1;
    }
    const Vec3 out = twice_area(mesh, t);
    const double steep = dot(out, way_);
    if (leaves == 0 || steep == 0) return std::nullopt;
    return Crossing{dot(out, mesh.points[t[0]] - from_) / steep, leaves};
  }

 private:
  Vec3 from_, way_, u_, v_;
};

}  // namespace affskel::core

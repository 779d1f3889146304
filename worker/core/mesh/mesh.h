#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec3.h"

namespace affskel::core {

using Triangle = std::array<std::uint32_t, 3>;

/// A piece of a curve: the indices of its two ends.
using Segment = std::array<std::uint32_t, 2>;

/// The segment between two points, the lower index first.
constexpr Segment ascending(std::uint32_t a, std::uint32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

constexpr bool uses(const Triangle& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

/// Whether it names a vertex twice.
constexpr bool is_collapsed(const Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

/// A triangle soup with shared vertices: plain data, no promise of being closed or manifold.
struct Mesh {
  std::vector<Vec3> points;
  std::vector<Triangle> triangles;  ///< indices into points; counter-clockwise seen from outside
};

/// Of a triangle, as a vector: along its normal, outward.
inline Vec3 twice_area(const Mesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.points[t[0]];
  return cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a);
}

/// Of the tetrahedron o, a, b, c: six times its volume; positive where a, b, c turn counter-clockwise seen from beyond
/// them.
inline double six_volumes(const Vec3& o, const Vec3& a, const Vec3& b, const Vec3& c) {
  return dot(a - o, cross(b - o, c - o));
}

/// Of a closed mesh, negative where it is inside out.  The sum of the tetrahedra from the first vertex: near the mesh, so
/// that little cancels.
inline double enclosed_volume(const Mesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles)
    sum += six_volumes(mesh.points.front(), mesh.points[t[0]], mesh.points[t[1]], mesh.points[t[2]]);
  return sum / 6;
}

}  // namespace affskel::core

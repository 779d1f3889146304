#include "core/repair/near_points.h"

#include <algorithm>
#include <limits>

#include "core/base/disjoint_sets.h"
#include "core/mesh/box.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

constexpr double kNearOfEdge = 1e-2;

// An end of open edges, and how far from it another may lie.
struct OpenEnd {
  std::uint32_t point;
  double tolerance;
};

// By x.
std::vector<OpenEnd> open_ends(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles) {
  const double none = std::numeric_limits<double>::infinity();
  std::vector<double> shortest(points.size(), none);  // open edge at a point
  Edges(points.size(), triangles).for_each([&](std::uint32_t low, std::uint32_t high, auto sides) {
    if (sides.size() != 1) return;
    const double length = norm(points[high] - points[low]);
    for (const std::uint32_t end : {low, high}) shortest[end] = std::min(shortest[end], length);
  });
  const double most = kNearOfDiagonal * box_of(points).diagonal();
  std::vector<OpenEnd> ends;
  for (std::uint32_t p = 0; p < points.size(); ++p)
    if (shortest[p] < none) ends.push_back({p, std::min(most, kNearOfEdge * shortest[p])});
  std::sort(ends.begin(), ends.end(), [&](const OpenEnd& a, const OpenEnd& b) {
    const double of_a = points[a.point].x, of_b = points[b.point].x;
    return of_a != of_b ? of_a < of_b : a.point < b.point;
  });
  return ends;
}

}  // namespace

std::uint64_t join_near_points(const std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  const std::vector<OpenEnd> ends = open_ends(points, triangles);
  DisjointSets same(points.size());
  std::uint64_t joined = 0;
  for (std::size_t a = 0; a < ends.size(); ++a) {
    const Vec3& at = points[ends[a].point];
    for (std::size_t b = a + 1; b < ends.size() && points[ends[b].point].x - at.x <= ends[a].tolerance; ++b) {
      if (norm(points[ends[b].point] - at) > std::min(ends[a].tolerance, ends[b].tolerance)) continue;
      joined += same.unite(ends[a].point, ends[b].point) ? 1 : 0;
    }
  }
  if (joined == 0) return 0;
  for (Triangle& t : triangles)
    for (std::uint32_t& corner : t) corner = same.find(corner);
  std::erase_if(triangles, is_collapsed);
  return joined;
}

}  // namespace affskel::core

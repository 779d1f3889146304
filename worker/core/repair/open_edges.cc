#include "core/repair/open_edges.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/mesh/box.h"
#include "core/mesh/edges.h"
#include "core/spatial/box_tree.h"

namespace affskel::core {
namespace {

constexpr double kNearOfDiagonal = 1e-6;  // of the box: what lies so near may be parted by rounding
constexpr double kNearOfEdge = 1e-2;      // of an end of open edges, from another
constexpr double kJunctionOfEdge = 1e-3;  // of a T-junction, from the edge
constexpr std::uint64_t kVisit = 100;     // of a tree, some nanoseconds each
constexpr int kEdgesOfATriangle = 3;      // it may have junctions on each

// An end of open edges, and how far from it another may lie.
struct OpenEnd {
  std::uint32_t point;
  double tolerance;
};

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
  return ends;
}

struct OpenEdge {
  std::uint32_t triangle, corner;  // from this corner to the next
};

class Junctions {
 public:
  Junctions(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles, double tolerance)
      : points_(points), triangles_(triangles), tolerance_(tolerance) {
    Edges(points.size(), triangles).for_each([&](std::uint32_t low, std::uint32_t high, auto sides) {
      if (sides.size() != 1) return;
      open_.push_back({sides[0].triangle(), sides[0].half_edge % 3});
      rim_.push_back(low);
      rim_.push_back(high);
    });
    std::sort(rim_.begin(), rim_.end());
    rim_.erase(std::unique(rim_.begin(), rim_.end()), rim_.end());
    std::vector<Box> boxes(rim_.size());
    for (std::size_t r = 0; r < rim_.size(); ++r) boxes[r].include(points[rim_[r]]);
    tree_ = BoxTree(std::move(boxes));
  }

  // The triangles with every junction of one edge each put in; the number of these.
  std::uint64_t split(std::vector<Triangle>& result) const {
    std::uint64_t found = 0;
    std::vector<bool> done(triangles_.size(), false);
    result = triangles_;
    for (const OpenEdge& edge : open_) {
      if (done[edge.triangle]) continue;
      const Triangle& t = triangles_[edge.triangle];
      const std::uint32_t a = t[edge.corner], b = t[(edge.corner + 1) % 3], c = t[(edge.corner + 2) % 3];
      const std::vector<std::uint32_t> between = on_edge(a, b, c);
      if (between.empty()) continue;
      done[edge.triangle] = true;
      found += between.size();
      result[edge.triangle] = {a, between.front(), c};
      for (std::size_t i = 0; i < between.size(); ++i)
        result.push_back({between[i], i + 1 < between.size() ? between[i + 1] : b, c});
    }
    return found;
  }

 private:
  // Vertices of the rim on the edge from a to b, in that order.
  std::vector<std::uint32_t> on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vec3 from = points_[a], along = points_[b] - from;
    const double length = norm(along), near = std::min(tolerance_, kJunctionOfEdge * length);
    std::vector<std::pair<double, std::uint32_t>> found;
    tree_.visit(WayQuery{from, along, near}, [&](std::uint32_t r) {
      const std::uint32_t v = rim_[r];
      const Vec3 way = points_[v] - from;
      const double t = dot(way, along) / length;
      if (v == a || v == b || v == c || !(t > near && t < length - near)) return;
      if (norm(cross(way, along)) <= near * length) found.emplace_back(t, v);
    });
    std::sort(found.begin(), found.end());
    std::vector<std::uint32_t> vertices;
    for (const auto& [t, v] : found) vertices.push_back(v);
    return vertices;
  }

  const std::vector<Vec3>& points_;
  const std::vector<Triangle>& triangles_;
  double tolerance_;
  std::vector<OpenEdge> open_;
  std::vector<std::uint32_t> rim_;
  BoxTree tree_;
};

}  // namespace

std::uint64_t join_near_points(const std::vector<Vec3>& points, std::vector<Triangle>& triangles,
                               ExecutionContext* context) {
  StopCheck stop(context);
  const std::vector<OpenEnd> ends = open_ends(points, triangles);
  std::vector<Box> boxes(ends.size());
  for (std::size_t e = 0; e < ends.size(); ++e) boxes[e].include(points[ends[e].point]);
  const BoxTree tree(std::move(boxes));
  DisjointSets same(points.size());
  std::uint64_t joined = 0;
  for (std::uint32_t a = 0; a < ends.size(); ++a) {
    const Vec3& at = points[ends[a].point];
    const double near = ends[a].tolerance;
    stop.did(kVisit);
    tree.visit_above(Box{at, at}.widened(near), a, [&](std::uint32_t b) {
      stop.did(1);
      if (norm(points[ends[b].point] - at) > std::min(near, ends[b].tolerance)) return;
      joined += same.unite(ends[a].point, ends[b].point) ? 1 : 0;
    });
  }
  if (joined == 0) return 0;
  for (Triangle& t : triangles)
    for (std::uint32_t& corner : t) corner = same.find(corner);
  std::erase_if(triangles, is_collapsed);
  return joined;
}

std::uint64_t split_t_junctions(const std::vector<Vec3>& points, std::vector<Triangle>& triangles) {
  const double tolerance = kNearOfDiagonal * box_of(points).diagonal();
  std::uint64_t found = 0;
  for (int round = 0; round < kEdgesOfATriangle; ++round) {
    std::vector<Triangle> result;
    const std::uint64_t now = Junctions(points, triangles, tolerance).split(result);
    if (now == 0) break;
    found += now;
    triangles = std::move(result);
  }
  return found;
}

}  // namespace affskel::core

#include "core/spatial/self_intersection.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Intersections_3/Segment_3_Triangle_3.h>
#include <CGAL/Intersections_3/Triangle_3_Triangle_3.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/spatial/box_tree.h"
#include "core/spatial/close_triangles.h"

namespace affskel::core {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

[[noreturn]] void refuse_corner(std::size_t triangle, std::uint32_t vertex, const std::string& cause) {
  refuse("triangle " + std::to_string(triangle) + ", vertex " + std::to_string(vertex) + ": " + cause);
}

void check(const Mesh& mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (const std::uint32_t v : mesh.triangles[i]) {
      if (v >= mesh.points.size()) {
        refuse_corner(i, v, "there are only " + std::to_string(mesh.points.size()) + " vertices");
      }
      if (!is_finite(mesh.points[v])) refuse_corner(i, v, "a coordinate is not finite");
    }
  }
}

/// Triangle t with its corners turned so that the ones it shares with another come first.
struct Turned {
  std::array<std::uint32_t, 3> corner;
  std::size_t shared = 0;
};

Turned shared_first(const Triangle& t, const Triangle& other) {
  Turned turned{};
  std::size_t from_back = 3;
  for (const std::uint32_t v : t) {
    const bool common = uses(other, v);
    turned.corner[common ? turned.shared++ : --from_back] = v;
  }
  return turned;
}

Point point_of(const std::vector<Vec3>& points, std::uint32_t v) {
  const Vec3& p = points[v];
  return {p.x, p.y, p.z};
}
Kernel::Triangle_3 triangle_of(const std::vector<Vec3>& points, const Triangle& t) {
  return {point_of(points, t[0]), point_of(points, t[1]), point_of(points, t[2])};
}

/// Of the side opposite to the one shared vertex.
Box side_box(const std::vector<Vec3>& points, const Turned& turned) {
  return box_of(std::array{points[turned.corner[1]], points[turned.corner[2]]});
}

/// False only where triangles, which have these boxes, surely meet in no more than their one shared vertex.  Cheap: in the
/// fan of triangles round a vertex all boxes meet, but hardly a side comes near another triangle.
bool may_meet(const Mesh& mesh, const std::vector<Box>& boxes, std::uint32_t i, std::uint32_t j) {
  const Triangle &s = mesh.triangles[i], &t = mesh.triangles[j];
  const Turned a = shared_first(s, t);
  return a.shared != 1 || side_box(mesh.points, a).meets(boxes[j]) ||
         side_box(mesh.points, shared_first(t, s)).meets(boxes[i]);
}

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// Goes through the triangles in blocks, several at a time.  Blocks are begun in ascending order and ended
// once begun, so the pairs of all blocks begun start with the first pairs of the mesh.
class Search {
 public:
  Search(const Mesh& mesh, const SelfIntersectionOptions& options)
      : mesh_(mesh), options_(options), degenerate_(mesh.triangles.size()) {}

  Pairs run() {
    const std::size_t count = mesh_.triangles.size();
    parallel_ranges(options_.threads, count, [this](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        degenerate_[i] = is_degenerate(mesh_.points, mesh_.triangles[i]);
    });
    throw_if_stopped(options_.context);
    boxes_ = boxes_of(mesh_);
    const CloseTriangles close(mesh_, boxes_, options_.threads);
    std::vector<Pairs> found((count + kBlock - 1) / kBlock);
    std::atomic<std::size_t> pairs{0};
    parallel_for(options_.threads, found.size(), [&](std::size_t block) {
      if (pairs >= options_.max_pairs) return;
      throw_if_stopped(options_.context);
      find(close, block * kBlock, std::min(count, (block + 1) * kBlock), found[block]);
      pairs += found[block].size();
    });
    return first_of(found);
  }

 private:
  static constexpr std::size_t kBlock = 2048;
  static constexpr std::uint64_t kOperationsPerVisit = 4, kOperationsPerCandidate = 64;

  void find(const CloseTriangles& close, std::size_t begin, std::size_t end, Pairs& pairs) const {
    std::vector<std::uint32_t> candidates;
    StopCheck stop(options_.context);
    for (auto i = static_cast<std::uint32_t>(begin); i < end && pairs.size() < options_.max_pairs; ++i) {
      if (degenerate_[i] != 0) continue;
      candidates.clear();
      close.visit_above(i, [&](std::uint32_t j) {
        stop.did(kOperationsPerVisit);
        if (may_meet(mesh_, boxes_, i, j)) candidates.push_back(j);
      });
      std::sort(candidates.begin(), candidates.end());
      candidates.erase(std::unique(candidates.begin(), candidates.end()), candidates.end());
      for (const std::uint32_t j : candidates) {
        if (pairs.size() == options_.max_pairs) break;
        stop.did(kOperationsPerCandidate);
        if (degenerate_[j] == 0 && meet_beyond_common(mesh_.points, mesh_.triangles[i], mesh_.triangles[j]))
          pairs.emplace_back(i, j);
      }
    }
  }

  Pairs first_of(const std::vector<Pairs>& found) const {
    Pairs first;
    for (const Pairs& pairs : found) {
      const std::size_t wanted = std::min(pairs.size(), options_.max_pairs - first.size());
      first.insert(first.end(), pairs.begin(), pairs.begin() + static_cast<std::ptrdiff_t>(wanted));
    }
    return first;
  }

  const Mesh& mesh_;
  const SelfIntersectionOptions& options_;
  std::vector<std::uint8_t> degenerate_;  // bytes: neighbours may be written at the same time
  std::vector<Box> boxes_;
};

bool pierces(const Mesh& mesh, std::uint32_t from, std::uint32_t to, const Triangle& t) {
  const Point p = point_of(mesh.points, from), q = point_of(mesh.points, to);
  const std::array<Point, 3> c = {point_of(mesh.points, t[0]), point_of(mesh.points, t[1]),
                                  point_of(mesh.points, t[2])};
  const CGAL::Orientation side = CGAL::orientation(c[0], c[1], c[2], p);
  if (side == CGAL::COPLANAR || CGAL::orientation(c[0], c[1], c[2], q) != -side) return false;
  const CGAL::Orientation turn = CGAL::orientation(p, q, c[0], c[1]);
  return turn != CGAL::COPLANAR && CGAL::orientation(p, q, c[1], c[2]) == turn &&
         CGAL::orientation(p, q, c[2], c[0]) == turn;
}

}  // namespace

bool is_degenerate(const std::vector<Vec3>& points, const Triangle& t) {
  return is_collapsed(t) || triangle_of(points, t).is_degenerate();
}

bool meet_beyond_common(const std::vector<Vec3>& points, const Triangle& s, const Triangle& t) {
  const Turned a = shared_first(s, t), b = shared_first(t, s);
  const auto far_side = [&](const Turned& turned) {
    return Kernel::Segment_3(point_of(points, turned.corner[1]), point_of(points, turned.corner[2]));
  };
  switch (a.shared) {
    case 0:
      return CGAL::do_intersect(triangle_of(points, s), triangle_of(points, t));
    case 1: {
      // Whatever they share besides the vertex is convex and reaches the side opposite to the vertex
      // in one of the two.
      const auto reaches = [&](const Turned& turned, const Triangle& other) {
        return side_box(points, turned)
                   .meets(box_of(std::array{points[other[0]], points[other[1]], points[other[2]]})) &&
               CGAL::do_intersect(far_side(turned), triangle_of(points, other));
      };
      return reaches(a, t) || reaches(b, s);
    }
    case 2: {
      // They overlap only when they lie in one plane, on the same side of the edge.
      const Point p = point_of(points, a.corner[0]), q = point_of(points, a.corner[1]),
                  r = point_of(points, a.corner[2]), apex = point_of(points, b.corner[2]);
      return CGAL::coplanar(p, q, r, apex) && CGAL::coplanar_orientation(p, q, r, apex) == CGAL::POSITIVE;
    }
    default:
      return true;
  }
}

bool pass_through(const Mesh& mesh, std::uint32_t i, std::uint32_t j) {
  const Triangle &s = mesh.triangles[i], &t = mesh.triangles[j];
  for (std::size_t k = 0; k < 3; ++k) {
    if (pierces(mesh, s[k], s[(k + 1) % 3], t) || pierces(mesh, t[k], t[(k + 1) % 3], s)) return true;
  }
  return false;
}

bool triangles_meet(const Mesh& mesh, std::uint32_t i, std::uint32_t j) {
  const Kernel::Triangle_3 a = triangle_of(mesh.points, mesh.triangles[i]),
                           b = triangle_of(mesh.points, mesh.triangles[j]);
  return !a.is_degenerate() && !b.is_degenerate() && CGAL::do_intersect(a, b);
}

std::vector<std::pair<std::uint32_t, std::uint32_t>> self_intersections(
    const Mesh& mesh, const SelfIntersectionOptions& options) {
  check(mesh);
  return Search(mesh, options).run();
}

}  // namespace affskel::core

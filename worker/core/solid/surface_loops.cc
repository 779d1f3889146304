#include "core/solid/surface_loops.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

// Ways between the vertices of a mesh.
class Trees {
 public:
  explicit Trees(const Mesh& mesh) : depth_(mesh.points.size(), 0) {
    BreadthFirstTrees trees = breadth_first_trees(neighbours(mesh.points.size(), mesh.triangles));
    parent_ = std::move(trees.parent);
    for (const std::uint32_t v : trees.order)
      if (parent_[v] != v) depth_[v] = depth_[parent_[v]] + 1;
  }

  bool has_edge(std::uint32_t a, std::uint32_t b) const { return parent_[a] == b || parent_[b] == a; }

  // From a up to where the ways to the root meet, and down to b.
  std::vector<std::uint32_t> way(std::uint32_t a, std::uint32_t b) const {
    std::vector<std::uint32_t> up{a}, down{b};
    while (up.back() != down.back()) {
      std::vector<std::uint32_t>& deeper = depth_[up.back()] >= depth_[down.back()] ? up : down;
      deeper.push_back(parent_[deeper.back()]);
    }
    up.insert(up.end(), down.rbegin() + 1, down.rend());
    return up;
  }

 private:
  std::vector<std::uint32_t> parent_, depth_;  // per vertex
};

// A picture of a place, seen along a direction that no lattice and no model has, and how high it is.
struct Seen {
  double x = 0, y = 0, height = 0;
};

std::vector<Seen> seen(std::span<const Vec3> line) {
  std::vector<Seen> result;
  for (const Vec3& p : line)
    result.push_back({p.x + 0.3819660112501051 * p.z, p.y + 0.2360679774997897 * p.z, p.z});
  return result;
}

// How far a place lies to the left of the line from q to r, times their distance.
double leftness(const Seen& p, const Seen& q, const Seen& r) {
  return (r.x - q.x) * (p.y - q.y) - (r.y - q.y) * (p.x - q.x);
}

// What is nearer than this is in one place: then b is seen as moved by (e, e^2), e small (simulation of simplicity:
// Edelsbrunner and Mücke 1990).
constexpr double kSame = 1e-12;

// @param moved p is of b; else q and r are.
bool is_left(const Seen& p, const Seen& q, const Seen& r, bool moved) {
  const double left = leftness(p, q, r), dx = r.x - q.x, dy = r.y - q.y;
  if (std::abs(left) > kSame * (std::abs(dx) + std::abs(dy))) return left > 0;
  const double by_move = dy != 0 ? -dy : dx;
  return moved ? by_move > 0 : by_move < 0;
}

// Whether the segment from a to b passes over the one from c to d, which are of the line that may be moved.
bool passes_over(const Seen& a, const Seen& b, const Seen& c, const Seen& d) {
  if (std::max(a.x, b.x) < std::min(c.x, d.x) - kSame || std::max(c.x, d.x) < std::min(a.x, b.x) - kSame)
    return false;
  if (is_left(a, c, d, false) == is_left(b, c, d, false)) return false;
  if (is_left(c, a, b, true) == is_left(d, a, b, true)) return false;
  const auto height_at_meeting = [](const Seen& from, const Seen& to, const Seen& q, const Seen& r) {
    const double before = leftness(from, q, r), after = leftness(to, q, r);
    return before == after ? from.height
                           : from.height + before / (before - after) * (to.height - from.height);
  };
  return height_at_meeting(a, b, c, d) > height_at_meeting(c, d, a, b);
}

}  // namespace

std::vector<std::vector<std::uint32_t>> surface_loops(const Mesh& mesh) {
  const Trees trees(mesh);
  DisjointSets faces(mesh.triangles.size());
  std::vector<std::vector<std::uint32_t>> loops;
  Edges(mesh.points.size(), mesh.triangles)
      .for_each([&](std::uint32_t low, std::uint32_t high, std::span<const EdgeSide> sides) {
        if (!trees.has_edge(low, high) && !faces.unite(sides[0].triangle(), sides[1].triangle()))
          loops.push_back(trees.way(low, high));
      });
  return loops;
}

bool is_linked(std::span<const Vec3> a, std::span<const Vec3> b) {
  const std::vector<Seen> line = seen(a), other = seen(b);
  bool odd = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    for (std::size_t j = 0; j < other.size(); ++j)
      odd ^= passes_over(line[i], line[(i + 1) % line.size()], other[j], other[(j + 1) % other.size()]);
  }
  return odd;
}

}  // namespace affskel::core

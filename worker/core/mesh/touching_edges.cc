#include "core/mesh/touching_edges.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/disjoint_sets.h"
#include "core/base/none.h"

namespace affskel::core {
namespace {

// Radians: faces that lie on each other differ by rounding.
constexpr double kSameAngle = 1e-11;

// A triangle about an edge.
struct Leaf {
  double angle = 0;    // counter-clockwise, seen against the edge
  bool opens = false;  // the solid begins with it
  std::uint32_t half_edge = 0;
};

// The two axes across an edge; false where it has no length.
bool axes_across(const Vec3& edge, Vec3& first, Vec3& second) {
  const double length = norm(edge);
  if (!(length > 0)) return false;
  const Vec3 along = (1 / length) * edge;
  const Vec3 least = std::fabs(along.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
  const Vec3 across = cross(along, least);
  first = (1 / norm(across)) * across;
  second = cross(along, first);
  return true;
}

// In the order of their angles; of those at one angle the ones that end the solid come first.
void sort_leaves(std::vector<Leaf>& leaves) {
  std::ranges::sort(leaves, {}, &Leaf::angle);
  for (std::size_t begin = 0, end; begin < leaves.size(); begin = end) {
    for (end = begin + 1; end < leaves.size() && leaves[end].angle - leaves[end - 1].angle < kSameAngle;)
      ++end;
    std::stable_sort(leaves.begin() + static_cast<std::ptrdiff_t>(begin),
                     leaves.begin() + static_cast<std::ptrdiff_t>(end),
                     [](const Leaf& a, const Leaf& b) { return a.opens < b.opens; });
  }
}

bool take_leaves(const Mesh& mesh, std::span<const EdgeSide> sides, bool inside_out,
                 std::vector<Leaf>& leaves) {
  const Triangle& any = mesh.triangles[sides[0].triangle()];
  const std::uint32_t high = sides[0].high, i = sides[0].half_edge % 3;
  const std::uint32_t low = any[i] == high ? any[(i + 1) % 3] : any[i];
  Vec3 first, second;
  if (!axes_across(mesh.points[high] - mesh.points[low], first, second)) return false;
  for (const EdgeSide& side : sides) {
    const Triangle& t = mesh.triangles[side.triangle()];
    const std::uint32_t corner = side.half_edge % 3;
    const Vec3 tip = mesh.points[t[(corner + 2) % 3]] - mesh.points[low];
    const double x = dot(tip, first), y = dot(tip, second);
    if (!(std::hypot(x, y) > 0)) return false;
    double angle = std::atan2(y, x);
    // The cut of the circle must not part faces that lie on each other.
    if (angle > std::numbers::pi - kSameAngle) angle -= 2 * std::numbers::pi;
    // A triangle that runs up along the edge has the solid at the lesser angles.
    leaves.push_back({angle, (t[corner] == low) == inside_out, side.half_edge});
  }
  sort_leaves(leaves);
  return true;
}

// A triangle's edge gets a vertex between its ends: the triangle keeps the second half, the first is appended.
void divide(Mesh& mesh, std::uint32_t half_edge, std::uint32_t vertex) {
  Triangle& t = mesh.triangles[half_edge / 3];
  const std::uint32_t i = half_edge % 3, from = t[i], tip = t[(i + 2) % 3];
  t[i] = vertex;
  mesh.triangles.push_back({from, vertex, tip});
}

// Parts may touch along an edge whose ends they have in common on other ways: all but one then have a vertex within it.
// Returns whether it has divided any; a triangle at one edge at a time.
bool divide_doubled_edges(Mesh& mesh, bool inside_out) {
  MatedSides doubled;
  Edges(mesh.points.size(), mesh.triangles)
      .for_each([&](std::uint32_t, std::uint32_t, std::span<const EdgeSide> sides) {
        if (sides.size() <= 2) return;
        const MatedSides mated = mate_across_solid(mesh, sides, inside_out);
        if (!mated.empty()) doubled.insert(doubled.end(), mated.begin() + 1, mated.end());
      });
  std::vector<bool> used(mesh.triangles.size(), false);
  for (const auto& [a, b] : doubled) {
    if (used[a / 3] || used[b / 3]) continue;
    used[a / 3] = used[b / 3] = true;
    const Triangle& t = mesh.triangles[a / 3];
    const auto middle = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.push_back(0.5 * (mesh.points[t[a % 3]] + mesh.points[t[(a % 3 + 1) % 3]]));
    divide(mesh, a, middle);
    divide(mesh, b, middle);
  }
  return !doubled.empty();
}

}  // namespace

MatedSides mate_across_solid(const Mesh& mesh, std::span<const EdgeSide> sides, bool inside_out) {
  std::vector<Leaf> leaves;
  if (sides.size() % 2 != 0 || !take_leaves(mesh, sides, inside_out, leaves)) return {};
  if (std::ranges::count(leaves, true, &Leaf::opens) != static_cast<std::ptrdiff_t>(leaves.size() / 2))
    return {};
  MatedSides mated;
  std::vector<std::uint32_t> open;  // what the solid began with and has not ended
  // Twice round: it may have begun before the first angle.
  for (std::size_t n = 0; n < 2 * leaves.size() && mated.size() < leaves.size() / 2; ++n) {
    const Leaf& leaf = leaves[n % leaves.size()];
    if (leaf.opens) {
      if (n < leaves.size()) open.push_back(leaf.half_edge);
    } else if (!open.empty()) {
      const bool ended =
          std::ranges::any_of(mated, [&](const auto& pair) { return pair.second == leaf.half_edge; });
      if (ended) continue;
      mated.emplace_back(open.back(), leaf.half_edge);
      open.pop_back();
    }
  }
  return mated;
}

std::uint32_t separate_touching_edges(Mesh& mesh) {
  const bool inside_out = enclosed_volume(mesh) < 0;
  DisjointSets corners(3 * mesh.triangles.size());  // those that are one vertex
  std::vector<bool> touched(mesh.points.size(), false);
  const auto corner_at = [&](std::uint32_t half_edge, std::uint32_t vertex) {
    const std::uint32_t first = half_edge - half_edge % 3, next = first + (half_edge + 1) % 3;
    return mesh.triangles[half_edge / 3][half_edge % 3] == vertex ? half_edge : next;
  };
  Edges(mesh.points.size(), mesh.triangles)
      .for_each([&](std::uint32_t low, std::uint32_t high, std::span<const EdgeSide> sides) {
        MatedSides mated;
        if (sides.size() > 2) mated = mate_across_solid(mesh, sides, inside_out);
        if (!mated.empty()) touched[low] = touched[high] = true;
        if (mated.empty())
          for (const EdgeSide& side : sides.subspan(1))
            mated.emplace_back(sides[0].half_edge, side.half_edge);
        for (const auto& [a, b] : mated)
          for (const std::uint32_t end : {low, high}) corners.unite(corner_at(a, end), corner_at(b, end));
      });
  const auto points = static_cast<std::uint32_t>(mesh.points.size());
  std::vector<std::uint32_t> vertex_of(3 * mesh.triangles.size(), kNone);  // by the first corner of a set
  std::vector<bool> taken(points, false);
  for (std::uint32_t h = 0; h < 3 * mesh.triangles.size(); ++h) {
    std::uint32_t& vertex = mesh.triangles[h / 3][h % 3];
    if (!touched[vertex]) continue;
    std::uint32_t& own = vertex_of[corners.find(h)];
    if (own == kNone) {
      own = taken[vertex] ? static_cast<std::uint32_t>(mesh.points.size()) : vertex;
      if (taken[vertex]) mesh.points.push_back(mesh.points[vertex]);
      taken[vertex] = true;
    }
    vertex = own;
  }
  while (divide_doubled_edges(mesh, inside_out)) {
  }
  return static_cast<std::uint32_t>(mesh.points.size()) - points;
}

}  // namespace affskel::core

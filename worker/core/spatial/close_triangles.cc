#include "core/spatial/close_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "core/base/unit.h"

namespace affskel::core {
namespace {

// Fans of more triangles, and slivers when there are more, get boxes of their own.  For fewer, comparing all
// of them costs less.
constexpr std::uint32_t kMaxLoose = 64;

constexpr double kEps = std::numeric_limits<double>::epsilon();

// Holds the arc that side pq draws on the unit sphere round v.  The arc lies within its rise of the chord.
// Two triangles pqv and rsv, each with an area, have more in common than v only if their arcs meet.
Box arc_box(const Vec3& v, const Vec3& p, const Vec3& q) {
  const Box everything = {{-1, -1, -1}, {1, 1, 1}};
  const Vec3 to_p = p - v, to_q = q - v;
  const double size_p = largest_component(to_p), size_q = largest_component(to_q);
  if (!(size_p > 0 && size_q > 0 && std::isfinite(size_p) && std::isfinite(size_q))) return everything;
  // The largest component first: squares must not leave the range of a double.
  const Vec3 unit_p = unit(to_p / size_p), unit_q = unit(to_q / size_q);
  const double rise = 1 - norm(0.5 * (unit_p + unit_q));
  return box_of(std::array{unit_p, unit_q}).widened(rise + 16 * kEps);
}

std::vector<Box> arc_boxes(const Mesh& mesh, std::uint32_t vertex, const std::vector<std::uint32_t>& fan) {
  std::vector<Box> arcs;
  arcs.reserve(fan.size());
  for (const std::uint32_t i : fan) {
    const Triangle& t = mesh.triangles[i];
    const std::size_t at = t[1] == vertex ? 1 : t[2] == vertex ? 2 : 0;
    arcs.push_back(arc_box(mesh.points[vertex], mesh.points[t[(at + 1) % 3]], mesh.points[t[(at + 2) % 3]]));
  }
  return arcs;
}

// Whether the box reaches far beyond a triangle's width in two directions or three.
bool is_oblique_sliver(const Box& box, const Corners& corners, double unit) {
  constexpr double kFar = 64;
  const Vec3 a = corners[1] - corners[0], b = corners[2] - corners[1], c = corners[0] - corners[2];
  std::array<double, 3> sides{};
  for (std::size_t k = 0; k < 3; ++k) sides[k] = unit * (box.high[k] - box.low[k]);
  std::sort(sides.begin(), sides.end());
  const double longest = std::max({dot(a, a), dot(b, b), dot(c, c)});
  const Vec3 area = cross(a, b);
  return sides[1] * sides[1] * longest > kFar * kFar * dot(area, area);
}

}  // namespace

std::uint32_t CloseTriangles::Members::count_up_to(std::uint32_t i) const {
  return static_cast<std::uint32_t>(std::upper_bound(index.begin(), index.end(), i) - index.begin());
}

CloseTriangles::CloseTriangles(const Mesh& mesh, const std::vector<Box>& boxes, unsigned threads)
    : boxes_(boxes), triangles_(mesh) {
  assign_groups(mesh);
  if (groups_.empty()) {
    loose_.tree = BoxTree(boxes, threads);
    return;
  }
  std::vector<Box> loose, whole;
  for (const std::uint32_t t : loose_.members.index) loose.push_back(boxes[t]);
  loose_.tree = BoxTree(std::move(loose), threads);
  for (Group& group : groups_) {
    const std::vector<std::uint32_t>& index = group.members.index;
    group.tree = OrientedBoxTree(triangles_, index, threads);
    if (group.is_fan()) group.arcs = BoxTree(arc_boxes(mesh, group.vertex, index), threads);
    whole.push_back(boxes[index.front()]);
    for (const std::uint32_t t : index) whole.back().include(boxes[t]);
  }
  group_tree_ = BoxTree(std::move(whole), threads);
}

// Each triangle goes to the largest of the large fans at its corners.  Smaller fans at its other corners are
// searched triangle by triangle.  Of two neighbouring vertices the one with fewer triangles counts; in a
// surface like a sphere's these numbers sum to O(N) (Chiba and Nishizeki 1985).
void CloseTriangles::assign_groups(const Mesh& mesh) {
  std::vector<std::uint32_t> valence(mesh.points.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    for (const std::uint32_t v : t) ++valence[v];
  }
  group_of_.assign(mesh.triangles.size(), kNone);
  std::map<std::uint32_t, std::uint32_t> fan_at;
  Group slivers;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle& t = mesh.triangles[i];
    const std::uint32_t home = *std::max_element(t.begin(), t.end(), [&](std::uint32_t v, std::uint32_t w) {
      return std::pair(valence[v], w) < std::pair(valence[w], v);
    });
    if (valence[home] > kMaxLoose) {
      const auto [place, added] = fan_at.emplace(home, static_cast<std::uint32_t>(groups_.size()));
      if (added) groups_.emplace_back().vertex = home;
      group_of_[i] = place->second;
      groups_[place->second].members.index.push_back(i);
    } else if (is_oblique_sliver(boxes_[i], triangles_.corners(i), triangles_.unit())) {
      slivers.members.index.push_back(i);
    }
  }
  if (slivers.members.index.size() > kMaxLoose) {
    for (const std::uint32_t i : slivers.members.index)
      group_of_[i] = static_cast<std::uint32_t>(groups_.size());
    groups_.push_back(std::move(slivers));
  }
  if (groups_.empty()) return;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    if (group_of_[i] == kNone) loose_.members.index.push_back(i);
  }
}

}  // namespace affskel::core

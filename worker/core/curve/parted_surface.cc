// Notation.  A triangle is mixed where the sample points next to it, about a spacing apart, have several parts.  Each round
// marks the longest edge of mixed triangles that are longer than the spacing, and of those that have another edge
// marked; then every triangle is divided by its marks alone, so that the pieces fit together.
#include "core/curve/parted_surface.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "core/base/unit.h"
#include "core/collapse/dual_complex.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/edges.h"
#include "core/ridge/row_band.h"

namespace affskel::core {
namespace {

constexpr std::int32_t kFarthest = 4;  // steps

std::uint32_t nearest_within(const NearPoints& points, const Vec3& at, std::int32_t reach) {
  double least = double(reach) * reach;
  std::uint32_t found = kNone;
  points.any_near(at, reach, [&](std::uint32_t rank, double square) {
    if (square > least || (square == least && found != kNone)) return false;
    least = square;
    found = rank;
    return false;
  });
  return found;
}

// @param at real indices.
std::uint32_t nearest_point(const NearPoints& points, const Vec3& at) {
  for (std::int32_t reach = 1; reach <= kFarthest; reach *= 2)
    if (const std::uint32_t found = nearest_within(points, at, reach); found != kNone) return found;
  return kNone;
}

class CutTriangles {
 public:
  CutTriangles(const Solid& solid, const Lattice& lattice, std::span<const std::uint32_t> part,
               ExecutionContext* context)
      : points_(lattice),
        indices_(lattice),
        spacing_(lattice.spacing / solid.scale()),
        part_(part),
        stop_(context),
        mesh_(solid.mesh) {}

  PartedSurface run() {
    const std::vector<Triangle>& all = mesh_.triangles;
    for (const Triangle& t : all) mixed_.push_back(mixed(t));
    while (mark()) divide();
    PartedSurface result;
    for (const Triangle& t : all) result.point.push_back(point_under(t, 1.0 / 3, 1.0 / 3));
    result.mesh = std::move(mesh_);
    return result;
  }

 private:
  const Vec3& place(std::uint32_t v) const { return mesh_.points[v]; }

  double length(std::uint32_t a, std::uint32_t b) const { return norm(place(b) - place(a)); }

  // The sample point next to a + u (b - a) + v (c - a).
  std::uint32_t point_under(const Triangle& t, double u, double v) {
    stop_.did(100);
    const Vec3 along = place(t[1]) - place(t[0]), across = place(t[2]) - place(t[0]);
    const Vec3 outward = unit(cross(along, across));
    return nearest_point(points_, indices_(place(t[0]) + u * along + v * across - 0.5 * spacing_ * outward));
  }

  // The triangle, its longest edge first: of equal ones that of the lesser corners, so that neighbours agree.
  Triangle by_longest(const Triangle& t) const {
    const auto key = [&](std::size_t k) {
      const Segment edge = ascending(t[k], t[(k + 1) % 3]);
      return std::tuple{-length(edge[0], edge[1]), edge};
    };
    const std::size_t k = key(0) < key(1) ? (key(0) < key(2) ? 0 : 2) : (key(1) < key(2) ? 1 : 2);
    return {t[k], t[(k + 1) % 3], t[(k + 2) % 3]};
  }

  // Asks in rows along the longest edge.
  bool mixed(const Triangle& triangle) {
    const Triangle t = by_longest(triangle);
    const double longest = length(t[0], t[1]);
    if (!(longest > spacing_)) return false;
    const double height = norm(cross(place(t[1]) - place(t[0]), place(t[2]) - place(t[0]))) / longest;
    const double rows = std::ceil(height / spacing_ + 1);
    std::uint32_t first = kNone;
    for (double row = 0.5; row < rows; ++row) {
      const double v = row / rows, places = std::ceil(longest * (1 - v) / spacing_ + 1);
      for (double at = 0.5; at < places; ++at) {
        const std::uint32_t point = point_under(t, at / places * (1 - v), v);
        if (point == kNone) continue;
        if (first == kNone) first = part_[point];
        if (part_[point] != first) return true;
      }
    }
    return false;
  }

  // In passes over the triangles, of those that have a cut since they were last looked at.
  // @return whether there is any edge to cut.
  bool mark() {
    middle_.clear();
    is_cut_.assign(mesh_.points.size(), 0);
    if (std::find(mixed_.begin(), mixed_.end(), 1) == mixed_.end()) return false;
    const Edges edges(mesh_.points.size(), mesh_.triangles);
    std::set<std::pair<std::size_t, std::uint32_t>> left;  // passes and triangles
    const auto cut = [&](std::size_t pass, std::uint32_t number) {
      const Triangle t = by_longest(mesh_.triangles[number]);
      if (!cut_longest(t)) return;
      for (const EdgeSide& side : edges.between(t[0], t[1]))
        left.emplace(pass > 0 && side.triangle() > number ? pass : pass + 1, side.triangle());
    };
    for (std::uint32_t t = 0; t < mixed_.size(); ++t)
      if (mixed_[t] != 0) cut(0, t);
    for (; !left.empty(); left.erase(left.begin())) {
      stop_.did(10);
      cut(left.begin()->first, left.begin()->second);
    }
    return true;
  }

  // @param t its longest edge first.
  bool cut_longest(const Triangle& t) {
    const auto [found, is_new] =
        middle_.try_emplace(ascending(t[0], t[1]), static_cast<std::uint32_t>(mesh_.points.size()));
    if (!is_new) return false;
    mesh_.points.push_back(0.5 * (place(found->first[0]) + place(found->first[1])));
    is_cut_[t[0]] = is_cut_[t[1]] = 1;
    return true;
  }

  bool has_cut(const Triangle& t) const {
    const auto is_cut = [&](std::size_t a, std::size_t b) {
      return is_cut_[t[a]] != 0 && is_cut_[t[b]] != 0 && middle_.contains(ascending(t[a], t[b]));
    };
    return is_cut(0, 1) || is_cut(1, 2) || is_cut(2, 0);
  }

  // The middle of an edge that is cut, else kNone.
  std::uint32_t middle(std::uint32_t a, std::uint32_t b) const {
    const auto found = middle_.find(ascending(a, b));
    return found == middle_.end() ? kNone : found->second;
  }

  // A triangle with any mark has one on its longest edge: two halves, each halved again where its own edge is marked.
  void divide() {
    std::vector<Triangle> whole;
    std::vector<char> mixed_of;
    std::swap(whole, mesh_.triangles);
    std::swap(mixed_of, mixed_);
    for (std::size_t t = 0; t < whole.size(); ++t) {
      if (!has_cut(whole[t])) {
        add(whole[t], mixed_of[t] != 0);
        continue;
      }
      const auto [a, b, c] = by_longest(whole[t]);
      const std::uint32_t m = middle(a, b);
      halve({b, c, m}, mixed_of[t] != 0);
      halve({c, a, m}, mixed_of[t] != 0);
    }
  }

  // Across its first edge, where that is cut.
  void halve(const Triangle& t, bool may_mix) {
    const std::uint32_t m = middle(t[0], t[1]);
    if (m == kNone) {
      add(t, may_mix);
      return;
    }
    add({t[2], t[0], m}, may_mix);
    add({t[1], t[2], m}, may_mix);
  }

  // Pieces of a triangle of one part are not asked again.
  void add(const Triangle& t, bool may_mix) {
    mesh_.triangles.push_back(t);
    mixed_.push_back(may_mix && mixed(t) ? 1 : 0);
  }

  const NearPoints points_;
  const LatticeIndices indices_;
  const double spacing_;  // scaled units
  const std::span<const std::uint32_t> part_;
  StopCheck stop_;
  Mesh mesh_;
  std::vector<char> mixed_;                  // per triangle, whether it is longer than the spacing and mixed
  std::map<Segment, std::uint32_t> middle_;  // of the edges that this round cuts
  std::vector<char> is_cut_;                 // per vertex before this round: whether such an edge ends there
};

}  // namespace

PartedSurface parted_surface(const Solid& solid, const Lattice& lattice, std::span<const std::uint32_t> part,
                             ExecutionContext* context) {
  return CutTriangles(solid, lattice, part, context).run();
}

}  // namespace affskel::core

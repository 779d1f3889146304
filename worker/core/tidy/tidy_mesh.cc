// Notation: the star of a vertex are the triangles that use it; the quality of a triangle is twice its area
// over the square of its longest side, 0.87 when it is regular.  Within a round, a change claims all vertices
// of the triangles it touches, and later ones leave stars with claimed vertices alone: the stars looked up at
// the start of the round stay true.
#include "core/tidy/tidy_mesh.h"

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "core/mesh/edges.h"
#include "core/mesh/unused_points.h"

namespace affskel::core {
namespace {

using Index = std::uint32_t;

struct ShortEdge {
  double square = 0;  // of its length
  Index a = 0, b = 0;
};

// Triangles below are slivers: a change may not make one, and their direction says nothing.
constexpr double kSliver = 0.1;
// Flat triangles below this quality are flipped.
constexpr double kFlatQuality = 0.3;
// Of collapses and flips; a lattice's mesh is done after about ten.
constexpr int kMaxRounds = 32;

class Tidier {
 public:
  Tidier(const Mesh& mesh, double length) : mesh_(mesh), limit_(length * length) {}

  Mesh run(ExecutionContext* context) {
    for (int round = 0; round < kMaxRounds; ++round) {
      throw_if_stopped(context);
      if (!change()) break;
    }
    drop_unused_points(mesh_);
    return std::move(mesh_);
  }

 private:
  bool change() {
    stars_ = holders(mesh_.points.size(), mesh_.triangles);
    claimed_.assign(mesh_.points.size(), 0);
    bool any = false;
    for (const ShortEdge& e : short_edges()) {
      if (claimed(e.a) || claimed(e.b)) continue;
      any = collapse(e.a, e.b) || collapse(e.b, e.a) || any;
    }
    for (Index t = 0; t < mesh_.triangles.size(); ++t) {
      if (mesh_.triangles[t][0] != mesh_.triangles[t][1] && quality(mesh_.triangles[t]) < kFlatQuality) {
        any = flip(t) || any;
      }
    }
    std::erase_if(mesh_.triangles, [](const Triangle& t) { return t[0] == t[1]; });
    return any;
  }

  std::span<const Index> star(Index v) const { return stars_[v]; }

  std::vector<ShortEdge> short_edges() const {
    std::vector<ShortEdge> edges;
    for (const Triangle& t : mesh_.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const Index a = t[k], b = t[(k + 1) % 3];
        const double square = squared_distance(mesh_.points[a], mesh_.points[b]);
        if (a < b && square < limit_) edges.push_back({square, a, b});
      }
    }
    std::sort(edges.begin(), edges.end(), [](const ShortEdge& e, const ShortEdge& f) {
      return std::tie(e.square, e.a, e.b) < std::tie(f.square, f.a, f.b);
    });
    return edges;
  }

  // Whether a vertex next to v, or v itself, has been used in this round.
  bool claimed(Index v) const {
    for (Index t : star(v)) {
      for (Index w : mesh_.triangles[t]) {
        if (claimed_[w] != 0) return true;
      }
    }
    return false;
  }

  std::vector<Index> neighbours(Index v) const {
    std::vector<Index> result;
    for (Index t : star(v)) {
      for (Index w : mesh_.triangles[t]) {
        if (w != v) result.push_back(w);
      }
    }
    std::sort(result.begin(), result.end());
    result.erase(std::unique(result.begin(), result.end()), result.end());
    return result;
  }

  /// Moves the corners at `from` to `to`, unless that would spoil the mesh.
  bool collapse(Index from, Index to) {
    if (!keeps_topology(from, to) || !keeps_shape(from, to)) return false;
    for (Index v : {from, to}) {
      for (Index t : star(v)) {
        for (Index w : mesh_.triangles[t]) claimed_[w] = 1;
      }
    }
    for (Index t : star(from)) {
      Triangle& triangle = mesh_.triangles[t];
      if (uses(triangle, to)) {
        triangle = {};
      } else {
        *std::find(triangle.begin(), triangle.end(), from) = to;
      }
    }
    return true;
  }

  /// The link condition of a closed surface: the ends have only the two corners opposite to the edge as
  /// common neighbours, and these lose a triangle each without falling below three.
  bool keeps_topology(Index a, Index b) const {
    const std::vector<Index> near_a = neighbours(a), near_b = neighbours(b);
    std::vector<Index> common;
    std::set_intersection(near_a.begin(), near_a.end(), near_b.begin(), near_b.end(),
                          std::back_inserter(common));
    return common.size() == 2 && star(common[0]).size() > 3 && star(common[1]).size() > 3;
  }

  /// Whether the triangles that change keep their direction and do not become slivers.
  bool keeps_shape(Index from, Index to) const {
    for (Index t : star(from)) {
      const Triangle& old = mesh_.triangles[t];
      // Triangles smaller than the edges to be collapsed have no reliable direction, and will be collapsed
      // themselves.
      if (uses(old, to) || longest_square(old) < limit_ / 4) continue;
      Triangle changed = old;
      *std::find(changed.begin(), changed.end(), from) = to;
      // A new needle is allowed: it still has a side to be collapsed.
      if (quality(changed) < std::min(kSliver, quality(old)) && shortest_square(changed) >= limit_)
        return false;
      constexpr double kMinCosine = 0.5;
      if (quality(old) > kSliver && !agree(twice_area(mesh_, old), twice_area(mesh_, changed), kMinCosine))
        return false;
    }
    return true;
  }

  static bool agree(const Vec3& v, const Vec3& w, double least_cosine) {
    return dot(v, w) >= least_cosine * (norm(v) * norm(w));
  }

  /// Replaces the longest side of a triangle by the other diagonal of the two triangles there, when that
  /// improves the worse one and keeps the direction.
  bool flip(Index t) {
    const std::size_t side = longest_side(mesh_.triangles[t]);
    const Index a = mesh_.triangles[t][side], b = mesh_.triangles[t][(side + 1) % 3];
    const Index c = mesh_.triangles[t][(side + 2) % 3];
    if (claimed(a) || claimed(b) || claimed(c)) return false;
    const auto over = std::find_if(star(a).begin(), star(a).end(),
                                   [&](Index s) { return s != t && uses(mesh_.triangles[s], b); });
    const Triangle other = mesh_.triangles[*over];
    const Index d = *std::find_if(other.begin(), other.end(), [&](Index v) { return v != a && v != b; });
    const std::vector<Index> near_c = neighbours(c);
    if (star(a).size() <= 3 || star(b).size() <= 3 || std::binary_search(near_c.begin(), near_c.end(), d) ||
        claimed(d)) {
      return false;
    }
    const Triangle first{a, d, c}, second{d, b, c};
    const Vec3 before = twice_area(mesh_, mesh_.triangles[t]) + twice_area(mesh_, other);
    constexpr double kMinCosine = 0.8;
    if (std::min(quality(first), quality(second)) <= quality(mesh_.triangles[t]) ||
        !agree(before, twice_area(mesh_, first), kMinCosine) ||
        !agree(before, twice_area(mesh_, second), kMinCosine)) {
      return false;
    }
    mesh_.triangles[t] = first;
    mesh_.triangles[*over] = second;
    for (Index v : {a, b, c, d}) claimed_[v] = 1;
    return true;
  }

  double side_square(const Triangle& t, std::size_t k) const {
    return squared_distance(mesh_.points[t[k]], mesh_.points[t[(k + 1) % 3]]);
  }

  std::size_t longest_side(const Triangle& t) const {
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k) {
      if (side_square(t, k) > side_square(t, longest)) longest = k;
    }
    return longest;
  }

  double longest_square(const Triangle& t) const { return side_square(t, longest_side(t)); }

  double shortest_square(const Triangle& t) const {
    return std::min({side_square(t, 0), side_square(t, 1), side_square(t, 2)});
  }

  double quality(const Triangle& t) const {
    const double square = longest_square(t);
    return square > 0 ? norm(twice_area(mesh_, t)) / square : 0;
  }

  Mesh mesh_;
  double limit_;
  Groups<Index> stars_;
  std::vector<std::uint8_t> claimed_;
};

}  // namespace

Mesh tidy_mesh(const Mesh& mesh, double shortest_edge, ExecutionContext* context) {
  return Tidier(mesh, shortest_edge).run(context);
}

}  // namespace affskel::core

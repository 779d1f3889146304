#include "core/ridge/ridge_rims.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <queue>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/require.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFU;
constexpr double kJustWeak = 1 - 1e-9;  // below the lower bound, but drawn back by nothing

// Edges of the mesh by their lower vertex: who is a neighbour of whom.
class Neighbours {
 public:
  explicit Neighbours(const RidgeMesh& mesh) : begin_(mesh.vertices.size() + 1, 0) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> sides;
    sides.reserve(6 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        sides.emplace_back(t[k], t[(k + 1) % 3]);
        sides.emplace_back(t[(k + 1) % 3], t[k]);
      }
    }
    std::sort(sides.begin(), sides.end());
    sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
    to_.reserve(sides.size());
    for (const auto& [from, to] : sides) {
      ++begin_[from + 1];
      to_.push_back(to);
    }
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  }

  template <class Visit>
  void of(std::uint32_t vertex, Visit visit) const {
    for (std::size_t n = begin_[vertex]; n < begin_[vertex + 1]; ++n) visit(to_[n]);
  }

 private:
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> to_;
};

class Cutting {
 public:
  Cutting(RidgeMesh& mesh, const RidgeRimOptions& options)
      : mesh_(mesh), options_(options), neighbours_(mesh), piece_(mesh.vertices.size(), kNone) {
    strength_.reserve(mesh.vertices.size());
    for (const RidgeVertex& v : mesh.vertices) strength_.push_back(v.strength);
  }

  RidgePieces run() {
    for (const double s : strength_) result_.max_strength = std::max(result_.max_strength, s);
    choose_pieces();
    leave_points();
    join_pieces();
    cut();
    return std::move(result_);
  }

 private:
  bool above(std::uint32_t vertex) const { return strength_[vertex] >= options_.low; }

  bool may_found_piece(const RidgeVertex& v) const {
    return v.strength >= options_.high && v.roundness <= options_.max_roundness;
  }

  // Sets which vertices hang together: all of them, or those above the lower bound alone.
  DisjointSets connected(bool strong_only) const {
    DisjointSets sets(mesh_.vertices.size());
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      if (strong_only && !above(v)) continue;
      neighbours_.of(v, [&](std::uint32_t to) {
        if (to > v && (!strong_only || above(to))) sets.unite(v, to);
      });
    }
    return sets;
  }

  // Sets piece_ of the vertices of kept pieces, to a vertex of the piece.
  void choose_pieces() {
    DisjointSets pieces = connected(true), sheets = connected(false);
    const std::size_t count = mesh_.vertices.size();
    std::vector<char> strong(count, 0);  // per piece
    for (std::uint32_t v = 0; v < count; ++v)
      if (may_found_piece(mesh_.vertices[v])) strong[pieces.find(v)] = 1;
    std::vector<double> area(count, 0);  // per sheet: of its strong pieces
    std::map<std::uint32_t, double> part_area;
    for (const Triangle& t : mesh_.triangles) {
      if (!above(t[0]) || !above(t[1]) || !above(t[2]) || !strong[pieces.find(t[0])]) continue;
      const double a = triangle_area(mesh_, t);
      area[sheets.find(t[0])] += a;
      part_area[mesh_.part[t[0]]] += a;
    }
    for (std::uint32_t v = 0; v < count; ++v) {
      const double whole = part_area[mesh_.part[v]];
      const double share = whole > 0 ? area[sheets.find(v)] / whole : 0;
      const bool significant = share > 0 && share >= options_.significance;
      if (sheets.find(v) == v) {
        result_.max_piece_share = std::max(result_.max_piece_share, share);
        if (significant) result_.shares.push_back(share);
      }
      if (significant && above(v) && strong[pieces.find(v)]) piece_[v] = pieces.find(v);
    }
    std::sort(result_.shares.begin(), result_.shares.end(), std::greater<>());
  }

  // In parts without a piece the vertex of greatest E becomes one, and all others weak.
  void leave_points() {
    std::map<std::uint32_t, std::uint32_t> deepest;  // by part; kNone: it has a piece
    for (std::uint32_t v = 0; v < piece_.size(); ++v) {
      const RidgeVertex& vertex = mesh_.vertices[v];
      if (vertex.strength < options_.high) continue;
      const auto [found, fresh] = deepest.try_emplace(mesh_.part[v], v);
      if (piece_[v] != kNone) found->second = kNone;
      if (found->second != kNone && vertex.erosion > mesh_.vertices[found->second].erosion) found->second = v;
    }
    for (std::uint32_t v = 0; v < piece_.size(); ++v) {
      const auto found = deepest.find(mesh_.part[v]);
      if (found == deepest.end() || found->second == kNone) continue;
      if (found->second == v) {
        piece_[v] = v;
        result_.shares.push_back(1);
      } else {
        strength_[v] = std::min(strength_[v], kJustWeak * options_.low);
      }
    }
  }

  // A way between two pieces: over the edge from `a` to `b`, and from both back to where they came from.
  struct Way {
    double cost;
    std::uint32_t a, b;
    friend auto operator<=>(const Way&, const Way&) = default;
  };

  // The cheapest ways from every vertex to a piece, by Dijkstra's algorithm from all pieces at once; edges
  // where the realms of two pieces meet are the ways between these; the cheapest of them join (Kruskal).
  void join_pieces() {
    walk();
    std::vector<Way> ways;
    for (std::uint32_t v = 0; v < owner_.size(); ++v) {
      if (owner_[v] == kNone) continue;
      neighbours_.of(v, [&](std::uint32_t to) {
        if (to > v && owner_[to] != kNone && owner_[to] != owner_[v])
          ways.push_back({cost_[v] + cost_[to] + cost(v, to), v, to});
      });
    }
    std::sort(ways.begin(), ways.end());
    DisjointSets joined(mesh_.vertices.size());
    for (const Way& way : ways) {
      if (joined.find(owner_[way.a]) == joined.find(owner_[way.b])) continue;
      joined.unite(owner_[way.a], owner_[way.b]);
      ++result_.bridges;
      keep(way.a);
      keep(way.b);
    }
  }

  double cost(std::uint32_t a, std::uint32_t b) const {
    const RidgeVertex &from = mesh_.vertices[a], &to = mesh_.vertices[b];
    return norm(to.position - from.position) * 2 * options_.low / (from.strength + to.strength);
  }

  void walk() {
    cost_.assign(piece_.size(), std::numeric_limits<double>::infinity());
    from_.assign(piece_.size(), kNone);
    owner_ = piece_;
    using Step = std::pair<double, std::uint32_t>;
    std::priority_queue<Step, std::vector<Step>, std::greater<>> next;
    for (std::uint32_t v = 0; v < piece_.size(); ++v) {
      if (piece_[v] == kNone) continue;
      cost_[v] = 0;
      next.push({0, v});
    }
    while (!next.empty()) {
      const auto [reached, v] = next.top();
      next.pop();
      if (reached > cost_[v]) continue;
      neighbours_.of(v, [&](std::uint32_t to) {
        const double further = reached + cost(v, to);
        if (!(further < cost_[to])) return;
        cost_[to] = further;
        from_[to] = v;
        owner_[to] = owner_[v];
        next.push({further, to});
      });
    }
  }

  // A way's vertices and their neighbours count as strong: it is a strip, not a line.
  void keep(std::uint32_t vertex) {
    for (std::uint32_t v = vertex; v != kNone && piece_[v] == kNone; v = from_[v]) {
      raise(v);
      neighbours_.of(v, [&](std::uint32_t to) { raise(to); });
    }
  }
  void raise(std::uint32_t vertex) { strength_[vertex] = std::max(strength_[vertex], options_.low); }

  // Draws the weak ends of edges back to the rim, and keeps the triangles with a strong corner that hang
  // together with a kept piece.
  void cut() {
    const auto count = static_cast<std::uint32_t>(mesh_.vertices.size());
    std::vector<char> strong(count);
    for (std::uint32_t v = 0; v < count; ++v) strong[v] = above(v);
    DisjointSets sets(count);
    std::vector<Triangle> kept;
    for (const Triangle& t : mesh_.triangles) {
      if (!strong[t[0]] && !strong[t[1]] && !strong[t[2]]) continue;
      kept.push_back(t);
      for (std::size_t k = 0; k < 3; ++k)
        if (strong[t[k]] && strong[t[(k + 1) % 3]]) sets.unite(t[k], t[(k + 1) % 3]);
    }
    std::vector<char> wanted(count, 0);
    for (std::uint32_t v = 0; v < count; ++v)
      if (piece_[v] != kNone) wanted[sets.find(v)] = 1;
    for (std::uint32_t v = 0; v < count; ++v) strong[v] = strong[v] && wanted[sets.find(v)];
    std::vector<RidgeVertex> rim = mesh_.vertices;
    for (std::uint32_t v = 0; v < count; ++v)
      if (!strong[v]) rim[v] = drawn_back(v, strong);
    mesh_.vertices = std::move(rim);
    mesh_.triangles.clear();
    for (const Triangle& t : kept)
      if (strong[t[0]] || strong[t[1]] || strong[t[2]]) mesh_.triangles.push_back(t);
    drop_unused_vertices(mesh_);
  }

  // The mean of the places on the edges from a weak vertex to strong ones where the strength is the lower
  // bound.
  RidgeVertex drawn_back(std::uint32_t vertex, const std::vector<char>& strong) const {
    const RidgeVertex& weak = mesh_.vertices[vertex];
    RidgeVertex mean = weak;
    std::uint32_t met = 0;
    neighbours_.of(vertex, [&](std::uint32_t to) {
      if (!strong[to]) return;
      // Strengths reach far up where the gradient vanishes; the line is near the weak end all the same.
      const double low = strength_[vertex], high = std::min(strength_[to], 4 * options_.low);
      const double t = high > low ? std::clamp((options_.low - low) / (high - low), 0.0, 1.0) : 0;
      ++met;
      mean = between(mean, between(weak, mesh_.vertices[to], t), 1 / static_cast<double>(met));
    });
    if (met > 0) mean.strength = options_.low;
    return mean;
  }

  RidgeMesh& mesh_;
  const RidgeRimOptions& options_;
  Neighbours neighbours_;
  std::vector<double> strength_;      // per vertex: its own, or what it is taken for
  std::vector<std::uint32_t> piece_;  // per vertex: of a kept piece, or kNone
  std::vector<std::uint32_t> owner_;  // per vertex: the piece that it is nearest to
  std::vector<std::uint32_t> from_;   // per vertex: the next one on the way to that piece
  std::vector<double> cost_;          // per vertex: of that way
  RidgePieces result_;
};

}  // namespace

RidgePieces cut_rims(RidgeMesh& mesh, const RidgeRimOptions& options) {
  require_within(options.low, 1e-6, 1000,
                 "the lower bound of a ridge's strength must lie between 1e-6 and 1000");
  require_within(options.high, options.low, 1e6,
                 "the higher bound of a ridge's strength must be at least the lower one");
  require_within(options.significance, 0, 1, "the significance must lie between 0 and 1");
  return Cutting(mesh, options).run();
}

}  // namespace affskel::core

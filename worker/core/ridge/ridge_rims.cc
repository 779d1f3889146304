#include "core/ridge/ridge_rims.h"

#include <algorithm>
#include <functional>
#include <map>
#include <utility>

#include "core/base/cheapest_ways.h"
#include "core/base/disjoint_sets.h"
#include "core/base/require.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

constexpr double kJustWeak = 1 - 1e-9;  // below the lower bound, but drawn back by nothing

class Cutting {
 public:
  Cutting(SheetMesh& mesh, const RidgeBounds& bounds, const RidgeConstants& constants)
      : mesh_(mesh),
        bounds_(bounds),
        constants_(constants),
        neighbours_(neighbours(mesh.vertices.size(), mesh.triangles)),
        piece_(mesh.vertices.size(), kNoNode) {
    strength_.reserve(mesh.vertices.size());
    for (const SheetVertex& v : mesh.vertices) strength_.push_back(v.strength);
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
  bool above(std::uint32_t vertex) const { return strength_[vertex] >= bounds_.low; }

  bool may_found_piece(const SheetVertex& v) const {
    return v.strength >= bounds_.high && v.roundness <= constants_.max_roundness;
  }

  // Sets which vertices hang together: all of them, or those above the lower bound alone.
  DisjointSets connected(bool strong_only) const {
    DisjointSets sets(mesh_.vertices.size());
    for (std::uint32_t v = 0; v < mesh_.vertices.size(); ++v) {
      if (strong_only && !above(v)) continue;
      for (const std::uint32_t to : neighbours_[v])
        if (to > v && (!strong_only || above(to))) sets.unite(v, to);
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
      const bool significant = share > 0 && share >= constants_.significance;
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
    std::map<std::uint32_t, std::uint32_t> deepest;  // by part; kNoNode: it has a piece
    for (std::uint32_t v = 0; v < piece_.size(); ++v) {
      const SheetVertex& vertex = mesh_.vertices[v];
      if (vertex.strength < bounds_.high) continue;
      const auto [found, fresh] = deepest.try_emplace(mesh_.part[v], v);
      if (piece_[v] != kNoNode) found->second = kNoNode;
      if (found->second != kNoNode && vertex.erosion > mesh_.vertices[found->second].erosion)
        found->second = v;
    }
    for (std::uint32_t v = 0; v < piece_.size(); ++v) {
      const auto found = deepest.find(mesh_.part[v]);
      if (found == deepest.end() || found->second == kNoNode) continue;
      if (found->second == v) {
        piece_[v] = v;
        result_.shares.push_back(1);
      } else {
        strength_[v] = std::min(strength_[v], kJustWeak * bounds_.low);
      }
    }
  }

  // A way between two pieces: over the edge from `a` to `b`, and from both back to where they came from.
  struct Way {
    double cost;
    std::uint32_t a, b;
    friend auto operator<=>(const Way&, const Way&) = default;
  };

  // Pieces are joined over edges where their realms meet.
  void join_pieces() {
    CheapestWays ways(piece_);
    ways.find([&](std::uint32_t v, const auto& go) {
      for (const std::uint32_t to : neighbours_[v]) go(to, cost(v, to), v);
    });
    std::vector<Way> joins;
    for (std::uint32_t v = 0; v < piece_.size(); ++v) {
      for (const std::uint32_t to : neighbours_[v]) {
        if (to > v && ways.source[v] != kNoNode && ways.source[to] != kNoNode &&
            ways.source[to] != ways.source[v])
          joins.push_back({ways.cost[v] + ways.cost[to] + cost(v, to), v, to});
      }
    }
    DisjointSets joined(mesh_.vertices.size());
    const auto ends = [&](const Way& way) { return std::pair{ways.source[way.a], ways.source[way.b]}; };
    take_cheapest(std::move(joins), joined, ends, [&](const Way& way) {
      ++result_.bridges;
      keep(way.a, ways);
      keep(way.b, ways);
      return true;
    });
  }

  double cost(std::uint32_t a, std::uint32_t b) const {
    const SheetVertex &from = mesh_.vertices[a], &to = mesh_.vertices[b];
    return norm(to.position - from.position) * 2 * bounds_.low / (from.strength + to.strength);
  }

  // A way's vertices and their neighbours count as strong: it is a strip, not a line.
  void keep(std::uint32_t vertex, const CheapestWays& ways) {
    for (std::uint32_t v = vertex; v != kNoNode && piece_[v] == kNoNode; v = ways.step[v]) {
      raise(v);
      for (const std::uint32_t to : neighbours_[v]) raise(to);
    }
  }
  void raise(std::uint32_t vertex) { strength_[vertex] = std::max(strength_[vertex], bounds_.low); }

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
      if (piece_[v] != kNoNode) wanted[sets.find(v)] = 1;
    for (std::uint32_t v = 0; v < count; ++v) strong[v] = strong[v] && wanted[sets.find(v)];
    std::vector<SheetVertex> rim = mesh_.vertices;
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
  SheetVertex drawn_back(std::uint32_t vertex, const std::vector<char>& strong) const {
    const SheetVertex& weak = mesh_.vertices[vertex];
    SheetVertex mean = weak;
    std::uint32_t met = 0;
    for (const std::uint32_t to : neighbours_[vertex]) {
      if (!strong[to]) continue;
      // Strengths reach far up where the gradient vanishes; the line is near the weak end all the same.
      const double low = strength_[vertex], high = std::min(strength_[to], 4 * bounds_.low);
      const double t = high > low ? std::clamp((bounds_.low - low) / (high - low), 0.0, 1.0) : 0;
      ++met;
      mean = between(mean, between(weak, mesh_.vertices[to], t), 1 / static_cast<double>(met));
    }
    if (met > 0) mean.strength = bounds_.low;
    return mean;
  }

  SheetMesh& mesh_;
  const RidgeBounds& bounds_;
  const RidgeConstants& constants_;
  Adjacency neighbours_;
  std::vector<double> strength_;      // per vertex: its own, or what it is taken for
  std::vector<std::uint32_t> piece_;  // per vertex: of a kept piece, or kNoNode
  RidgePieces result_;
};

}  // namespace

RidgePieces cut_rims(SheetMesh& mesh, const RidgeBounds& bounds, const RidgeConstants& constants) {
  require_within(bounds.low, 1e-6, 1000,
                 "the lower bound of a ridge's strength must lie between 1e-6 and 1000");
  require_within(bounds.high, bounds.low, 1e6,
                 "the higher bound of a ridge's strength must be at least the lower one");
  return Cutting(mesh, bounds, constants).run();
}

}  // namespace affskel::core

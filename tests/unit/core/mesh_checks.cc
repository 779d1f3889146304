#include "core/mesh_checks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <utility>
#include <vector>

namespace affskel::core {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

class UnionFind {
 public:
  explicit UnionFind(std::size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0u); }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) { parent_[find(i)] = find(j); }

 private:
  std::vector<std::size_t> parent_;
};

Edge undirected(std::uint32_t v, std::uint32_t w) {
  return {std::min(v, w), std::max(v, w)};
}

/// Directed edges with the number of times each is walked.
std::map<Edge, int> directed_edges(const Mesh& mesh) {
  std::map<Edge, int> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  return edges;
}

/// Whether edges joined over common ends make one piece.
bool connected(const std::vector<Edge>& edges) {
  std::map<std::uint32_t, std::size_t> index;
  for (const Edge& e : edges) {
    index.try_emplace(e.first, index.size());
    index.try_emplace(e.second, index.size());
  }
  UnionFind joined(index.size());
  for (const Edge& e : edges) joined.join(index[e.first], index[e.second]);
  for (std::size_t i = 1; i < index.size(); ++i) {
    if (joined.find(i) != joined.find(0)) return false;
  }
  return true;
}

/// Whether the sides opposite to each vertex form one chain or ring.
bool fans_are_single(const Mesh& mesh) {
  std::map<std::uint32_t, std::vector<Edge>> opposite;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) opposite[t[k]].emplace_back(t[(k + 1) % 3], t[(k + 2) % 3]);
  }
  return std::all_of(opposite.begin(), opposite.end(), [](const auto& at) { return connected(at.second); });
}

void count_pieces(const Mesh& mesh, MeshFacts& facts) {
  UnionFind joined(mesh.points.size());
  std::set<std::uint32_t> used;
  for (const Triangle& t : mesh.triangles) {
    joined.join(t[0], t[1]);
    joined.join(t[0], t[2]);
    used.insert(t.begin(), t.end());
  }
  std::set<std::size_t> roots;
  for (const std::uint32_t v : used) roots.insert(joined.find(v));
  facts.components = roots.size();
  facts.unused_vertices = mesh.points.size() - used.size();
  facts.euler += static_cast<std::int64_t>(used.size());
}

}  // namespace

MeshFacts mesh_facts(const Mesh& mesh) {
  MeshFacts facts;
  facts.closed = facts.oriented = facts.balanced = true;
  std::map<Edge, int> triangles_at;
  const std::map<Edge, int> directed = directed_edges(mesh);
  for (const auto& [edge, times] : directed) {
    triangles_at[undirected(edge.first, edge.second)] += times;
    facts.oriented = facts.oriented && times == 1;
    const auto back = directed.find({edge.second, edge.first});
    facts.balanced = facts.balanced && back != directed.end() && back->second == times;
  }
  for (const auto& entry : triangles_at) facts.closed = facts.closed && entry.second == 2;
  facts.euler =
      static_cast<std::int64_t>(mesh.triangles.size()) - static_cast<std::int64_t>(triangles_at.size());
  count_pieces(mesh, facts);
  facts.vertices_manifold = fans_are_single(mesh);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.points[t[0]], &b = mesh.points[t[1]], &c = mesh.points[t[2]];
    facts.volume += dot(a, cross(b, c)) / 6;
    facts.area += norm(cross(b - a, c - a)) / 2;
  }
  return facts;
}

void expect_solid_boundary(const Mesh& mesh, std::int64_t genus) {
  const MeshFacts facts = mesh_facts(mesh);
  EXPECT_TRUE(facts.closed);
  EXPECT_TRUE(facts.oriented);
  EXPECT_TRUE(facts.vertices_manifold);
  EXPECT_EQ(facts.components, 1u);
  EXPECT_EQ(facts.unused_vertices, 0u);
  EXPECT_EQ(facts.euler, 2 - 2 * genus);
  EXPECT_GT(facts.volume, 0);
}

std::size_t section_curves(const Mesh& mesh, double z) {
  std::map<Edge, std::size_t> index;
  std::vector<std::pair<std::size_t, std::size_t>> steps;
  for (const Triangle& t : mesh.triangles) {
    std::vector<std::size_t> crossed;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = t[k], w = t[(k + 1) % 3];
      if ((mesh.points[v].z < z) == (mesh.points[w].z < z)) continue;
      crossed.push_back(index.try_emplace(undirected(v, w), index.size()).first->second);
    }
    if (crossed.size() == 2) steps.emplace_back(crossed[0], crossed[1]);
  }
  UnionFind joined(index.size());
  for (const auto& [i, j] : steps) joined.join(i, j);
  std::set<std::size_t> roots;
  for (std::size_t i = 0; i < index.size(); ++i) roots.insert(joined.find(i));
  return roots.size();
}

double winding_number(const Mesh& mesh, const Vec3& q) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.points[t[0]] - q, b = mesh.points[t[1]] - q, c = mesh.points[t[2]] - q;
    const double la = norm(a), lb = norm(b), lc = norm(c);
    sum +=
        2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
  }
  return sum / (4 * 3.14159265358979323846);
}

}  // namespace affskel::core

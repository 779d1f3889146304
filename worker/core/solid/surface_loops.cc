#include "core/solid/surface_loops.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>

#include "core/base/disjoint_sets.h"
#include "core/mesh/edges.h"

namespace affskel::core {
namespace {

constexpr std::uint32_t kUnseen = std::numeric_limits<std::uint32_t>::max();

// Per surface a tree of shortest ways, in edges.
struct Trees {
  std::vector<std::uint32_t> parent, depth;  // of a root itself, and 0

  explicit Trees(const Mesh& mesh) : parent(mesh.points.size(), kUnseen), depth(mesh.points.size(), 0) {
    const Adjacency beside = neighbours(mesh.points.size(), mesh.triangles);
    std::vector<std::uint32_t> row;
    for (std::uint32_t root = 0; root < parent.size(); ++root) {
      if (parent[root] != kUnseen) continue;
      parent[root] = root;
      row.assign(1, root);
      for (std::size_t n = 0; n < row.size(); ++n) {
        const std::uint32_t v = row[n];
        for (const std::uint32_t to : beside[v]) {
          if (parent[to] != kUnseen) continue;
          parent[to] = v;
          depth[to] = depth[v] + 1;
          row.push_back(to);
        }
      }
    }
  }

  // From one vertex to another of the same tree.
  std::vector<std::uint32_t> way(std::uint32_t from, std::uint32_t to) const {
    std::vector<std::uint32_t> there{from}, back{to};
    while (there.back() != back.back()) {
      std::vector<std::uint32_t>& deeper = depth[there.back()] < depth[back.back()] ? back : there;
      deeper.push_back(parent[deeper.back()]);
    }
    back.pop_back();
    there.insert(there.end(), back.rbegin(), back.rend());
    return there;
  }
};

}  // namespace

std::vector<std::vector<std::uint32_t>> surface_loops(const Mesh& mesh) {
  const Trees trees(mesh);
  DisjointSets together(mesh.triangles.size());
  std::vector<std::vector<std::uint32_t>> loops;
  Edges(mesh.points.size(), mesh.triangles)
      .for_each([&](std::uint32_t low, std::uint32_t high, std::span<const EdgeSide> sides) {
        if (trees.parent[low] == high || trees.parent[high] == low) return;
        if (!together.unite(sides.front().triangle(), sides.back().triangle()))
          loops.push_back(trees.way(low, high));
      });
  return loops;
}

}  // namespace affskel::core

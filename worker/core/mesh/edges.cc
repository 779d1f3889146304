#include "core/mesh/edges.h"

#include <algorithm>

#include "core/base/none.h"

namespace affskel::core {

Edges::Edges(std::size_t points, std::span<const Triangle> triangles, unsigned threads)
    : sides_(points, [&](const auto& put) {
        for (std::uint32_t h = 0; h < 3 * triangles.size(); ++h) {
          const Triangle& t = triangles[h / 3];
          const auto [low, high] = std::minmax(t[h % 3], t[(h + 1) % 3]);
          put(low, EdgeSide{high, h});
        }
      }) {
  parallel_ranges(threads, points, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) std::sort(sides_[v].begin(), sides_[v].end());
  });
}

std::span<const EdgeSide> Edges::between(std::uint32_t a, std::uint32_t b) const {
  const auto [low, high] = std::minmax(a, b);
  const std::span<const EdgeSide> all = sides_[low];
  const auto [first, last] =
      std::equal_range(all.begin(), all.end(), EdgeSide{high, 0},
                       [](const EdgeSide& s, const EdgeSide& t) { return s.high < t.high; });
  return {first, last};
}

Adjacency neighbours(std::size_t points, std::span<const Triangle> triangles) {
  const Edges edges(points, triangles);
  // Of a vertex first the lower neighbours come, as the higher ends of their edges, and then the higher ones.
  return {points, [&](const auto& put) {
            edges.for_each([&](std::uint32_t low, std::uint32_t high, const auto&) { put(high, low); });
            edges.for_each([&](std::uint32_t low, std::uint32_t high, const auto&) { put(low, high); });
          }};
}

Adjacency neighbours(std::size_t points, std::span<const Segment> segments) {
  return {points, [&](const auto& put) {
            for (const auto& [a, b] : segments) {
              put(a, b);
              put(b, a);
            }
          }};
}

BreadthFirstTrees breadth_first_trees(const Adjacency& around) {
  const std::size_t points = around.size();
  BreadthFirstTrees trees{{}, std::vector<std::uint32_t>(points, kNone)};
  const auto reach = [&](std::uint32_t vertex, std::uint32_t from) {
    if (trees.parent[vertex] != kNone) return;
    trees.parent[vertex] = from;
    trees.order.push_back(vertex);
  };
  std::size_t at = 0;
  for (std::uint32_t root = 0; root < points; ++root) {
    reach(root, root);
    for (; at < trees.order.size(); ++at) {
      for (const std::uint32_t to : around[trees.order[at]]) reach(to, trees.order[at]);
    }
  }
  return trees;
}

}  // namespace affskel::core

#include "core/collapse/shortest_loops.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/groups.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

constexpr std::uint32_t kNoEdge = 0xFFFFFFFFU;

class Graph {
 public:
  Graph(const DualComplex& complex, const CellSet& left, ExecutionContext* context) : context_(context) {
    std::unordered_map<Cell, std::uint32_t> number;
    left.for_each([&](Cell cell) {
      if (DualComplex::dimension(cell) != 0) return;
      number.emplace(cell, static_cast<std::uint32_t>(vertices_.size()));
      vertices_.push_back(cell);
    });
    DisjointSets joined(vertices_.size());
    left.for_each([&](Cell cell) {
      if (DualComplex::dimension(cell) != 1) return;
      std::array<std::uint32_t, 2> ends{};
      std::size_t n = 0;
      complex.for_each_face(cell, [&](Cell vertex) { ends[n++] = number.at(vertex); });
      const auto cofaces = complex.cofaces(cell);
      if (std::any_of(cofaces.begin(), cofaces.end(), [&](Cell square) { return left.has(square); }))
        joined.unite(ends[0], ends[1]);
      else
        edges_.push_back(ends);
    });
    for (auto& ends : edges_) ends = {joined.find(ends[0]), joined.find(ends[1])};
    at_ = Groups<std::uint32_t>(vertices_.size(), [&](const auto& put) {
      for (std::uint32_t e = 0; e < edges_.size(); ++e)
        for (const std::uint32_t end : edges_[e]) put(end, e);
    });
    // Every loop has an edge that is not in the forest.
    DisjointSets forest(vertices_.size());
    for (std::uint32_t e = 0; e < edges_.size(); ++e)
      if (!forest.unite(edges_[e][0], edges_[e][1])) chords_.push_back(e);
    way_.assign(vertices_.size(), kNoEdge);
    taken_.assign(edges_.size(), 0);
  }

  // Takes an edge of the shortest loop out. @return the loop's vertices; empty when there is none.
  std::vector<Cell> take_shortest() {
    std::vector<Cell> best;
    std::uint32_t chord = kNoEdge;
    for (const std::uint32_t e : chords_) {
      if (taken_[e]) continue;
      throw_if_stopped(context_);
      std::vector<Cell> loop =
          shortest_through(e, best.empty() ? kNoEdge : static_cast<std::uint32_t>(best.size()));
      if (loop.empty()) continue;
      best = std::move(loop);
      chord = e;
    }
    if (chord != kNoEdge) taken_[chord] = 1;
    return best;
  }

 private:
  // The shortest loop through an edge if it has fewer than `most` edges: breadth first from one end to the other.
  std::vector<Cell> shortest_through(std::uint32_t edge, std::uint32_t most) {
    const auto [from, to] = edges_[edge];
    std::vector<Cell> loop{vertices_[from]};
    if (from == to) return most > 1 ? loop : std::vector<Cell>{};
    std::vector<std::uint32_t> seen{from};
    way_[from] = edge;
    std::size_t next = 0;
    for (std::uint32_t steps = 2; steps < most && next < seen.size() && way_[to] == kNoEdge; ++steps) {
      for (const std::size_t end = seen.size(); next < end; ++next) {
        for (const std::uint32_t e : at_[seen[next]]) {
          const std::uint32_t there = other_end(e, seen[next]);
          if (taken_[e] || e == edge || way_[there] != kNoEdge) continue;
          way_[there] = e;
          seen.push_back(there);
        }
      }
    }
    if (way_[to] == kNoEdge)
      loop.clear();
    else
      for (std::uint32_t at = to; at != from; at = other_end(way_[at], at)) loop.push_back(vertices_[at]);
    for (const std::uint32_t vertex : seen) way_[vertex] = kNoEdge;
    return loop;
  }

  std::uint32_t other_end(std::uint32_t edge, std::uint32_t of) const {
    return edges_[edge][0] == of ? edges_[edge][1] : edges_[edge][0];
  }

  ExecutionContext* context_;
  std::vector<Cell> vertices_;
  std::vector<std::array<std::uint32_t, 2>> edges_;  // between vertices, one for all that squares join
  Groups<std::uint32_t> at_;                         // per vertex: its edges
  std::vector<std::uint32_t> chords_;
  std::vector<char> taken_;         // per edge
  std::vector<std::uint32_t> way_;  // per vertex: the edge that a search came by
};

}  // namespace

std::vector<std::vector<Cell>> shortest_loops(const DualComplex& complex, const CellSet& left,
                                              std::size_t count, ExecutionContext* context) {
  Graph graph(complex, left, context);
  std::vector<std::vector<Cell>> loops;
  while (loops.size() < count) {
    std::vector<Cell> loop = graph.take_shortest();
    if (loop.empty()) break;
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace affskel::core

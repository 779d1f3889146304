#include "core/collapse/shortest_loops.h"

#include <array>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "core/base/disjoint_sets.h"
#include "core/base/groups.h"
#include "core/base/none.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

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
      const auto [a, b] = complex.ends(cell);
      if (is_bare(complex, cell, left)) {
        edges_.push_back({number.at(a), number.at(b)});
        edge_cells_.push_back(cell);
      } else {
        joined.unite(number.at(a), number.at(b));
      }
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
    way_.assign(vertices_.size(), kNone);
    taken_.assign(edges_.size(), 0);
  }

  // Takes an edge of the shortest loop out. @return the loop; empty when there is none.
  CellLoop take_shortest() {
    CellLoop best;
    std::uint32_t chord = kNone;
    for (const std::uint32_t e : chords_) {
      if (taken_[e]) continue;
      throw_if_stopped(context_);
      CellLoop loop =
          shortest_through(e, best.edges.empty() ? kNone : static_cast<std::uint32_t>(best.edges.size()));
      if (loop.edges.empty()) continue;
      best = std::move(loop);
      chord = e;
    }
    if (chord != kNone) taken_[chord] = 1;
    return best;
  }

 private:
  // The shortest loop through an edge if it has fewer than `most` edges: breadth first from one end to the other.
  CellLoop shortest_through(std::uint32_t edge, std::uint32_t most) {
    const auto [from, to] = edges_[edge];
    if (from == to) return most > 1 ? CellLoop{{vertices_[from]}, {edge_cells_[edge]}} : CellLoop{};
    std::vector<std::uint32_t> seen{from};
    way_[from] = edge;
    std::size_t next = 0;
    for (std::uint32_t steps = 2; steps < most && next < seen.size() && way_[to] == kNone; ++steps) {
      for (const std::size_t end = seen.size(); next < end; ++next) {
        for (const std::uint32_t e : at_[seen[next]]) {
          const std::uint32_t there = other_end(e, seen[next]);
          if (taken_[e] || e == edge || way_[there] != kNone) continue;
          way_[there] = e;
          seen.push_back(there);
        }
      }
    }
    CellLoop loop;
    if (way_[to] != kNone) {  // way_[from] is the edge itself
      std::uint32_t at = from;
      do {
        loop.vertices.push_back(vertices_[at]);
        loop.edges.push_back(edge_cells_[way_[at]]);
        at = other_end(way_[at], at);
      } while (at != from);
    }
    for (const std::uint32_t vertex : seen) way_[vertex] = kNone;
    return loop;
  }

  std::uint32_t other_end(std::uint32_t edge, std::uint32_t of) const {
    return edges_[edge][0] == of ? edges_[edge][1] : edges_[edge][0];
  }

  ExecutionContext* context_;
  std::vector<Cell> vertices_;
  std::vector<std::array<std::uint32_t, 2>> edges_;  // between vertices, one for all that squares join
  std::vector<Cell> edge_cells_;                     // per edge
  Groups<std::uint32_t> at_;                         // per vertex: its edges
  std::vector<std::uint32_t> chords_;
  std::vector<char> taken_;         // per edge
  std::vector<std::uint32_t> way_;  // per vertex: the edge that a search came by
};

}  // namespace

std::vector<CellLoop> shortest_loops(const DualComplex& complex, const CellSet& left, std::size_t count,
                                     ExecutionContext* context) {
  Graph graph(complex, left, context);
  std::vector<CellLoop> loops;
  while (loops.size() < count) {
    CellLoop loop = graph.take_shortest();
    if (loop.edges.empty()) break;
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace affskel::core

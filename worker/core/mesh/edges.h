#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/groups.h"
#include "core/base/parallel.h"
#include "core/mesh/mesh.h"

namespace affskel::core {

/// An edge of triangles, whatever way it runs, as one of them has it.
struct EdgeSide {
  std::uint32_t high = 0;       ///< its vertex of the larger number
  std::uint32_t half_edge = 0;  ///< 3 t + i: from corner i to corner i + 1 (mod 3) of triangle t

  std::uint32_t triangle() const { return half_edge / 3; }
  friend auto operator<=>(const EdgeSide&, const EdgeSide&) = default;
};

/// The edges of triangles, in the order of their smaller vertex, then of the larger one, each with all its
/// sides, ascending.  Triangles may be anything: open, crowded, without a common orientation.
class Edges {
 public:
  /// @param points how many vertices there are.
  /// @param threads up to so many sort.
  Edges(std::size_t points, std::span<const Triangle> triangles, unsigned threads = 1);

  /// Calls visit(low, high, sides) once for every edge, sides a span of EdgeSide; from several threads at
  /// once when there are more than one.
  template <class Visit>
  void for_each(const Visit& visit, unsigned threads = 1) const {
    parallel_ranges(threads, sides_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) {
        const std::span<const EdgeSide> all = sides_[v];
        for (std::size_t first = 0, last; first < all.size(); first = last) {
          for (last = first + 1; last < all.size() && all[last].high == all[first].high;) ++last;
          visit(static_cast<std::uint32_t>(v), all[first].high, all.subspan(first, last - first));
        }
      }
    });
  }

  /// The sides of the edge between two vertices; none where there is no such edge.
  std::span<const EdgeSide> between(std::uint32_t a, std::uint32_t b) const;

 private:
  Groups<EdgeSide> sides_;  // by the smaller vertex
};

/// The neighbours: of every vertex the others of its triangles, ascending.
using Adjacency = Groups<std::uint32_t>;

Adjacency neighbours(std::size_t points, std::span<const Triangle> triangles);

/// Of every vertex the other ends of its segments, in their order.
Adjacency neighbours(std::size_t points, std::span<const Segment> segments);

/// Breadth first trees over the vertices, one for all that are connected, from their first vertex on; neighbours in their order.
struct BreadthFirstTrees {
  std::vector<std::uint32_t> order;   ///< of the vertices, tree by tree
  std::vector<std::uint32_t> parent;  ///< per vertex; of a root itself
};
BreadthFirstTrees breadth_first_trees(const Adjacency& around);

}  // namespace affskel::core

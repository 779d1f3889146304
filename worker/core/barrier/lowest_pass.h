#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/mesh/edges.h"

namespace affskel::core {

/// The minimum that steepest descent reaches: from a vertex to its least neighbour and on, while that is less
/// (by value, then by index).
/// @param values one per vertex of the graph, not NaN.
std::uint32_t minimum_below(const Adjacency& graph, std::span<const float> values, std::uint32_t from);

/// Minimax paths on a graph, one after the other, reusing their memory.  One per thread.
class LowestPass {
 public:
  /// @param graph connected; must outlive this.
  explicit LowestPass(const Adjacency& graph) : graph_(graph), seen_(graph.size(), 0) {}

  /// The level of the lowest pass: the least, over all paths from one vertex to another, of the greatest
  /// value on the path, both ends included.  By flooding from `from`, always over the lowest vertex of the
  /// shore (Prim 1957): O(n log n) in the n vertices below the pass and their neighbours.
  /// @param values one per vertex of the graph, not NaN.
  float between(std::span<const float> values, std::uint32_t from, std::uint32_t to);

 private:
  void reach(std::span<const float> values, std::uint32_t vertex);

  const Adjacency& graph_;
  std::vector<std::uint32_t> seen_;                     // per vertex: the flood that reached it last
  std::vector<std::pair<float, std::uint32_t>> shore_;  // values and vertices: a heap, the lowest first
  std::uint32_t flood_ = 0;
};

}  // namespace affskel::core

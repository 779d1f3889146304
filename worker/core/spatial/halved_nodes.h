#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/mesh/box.h"

namespace affskel::core {

/// Puts `left` of some items in front of the others, by their centres along the axis in which these are spread most, of
/// equal ones by their numbers.  The centres', not the boxes': the faces of boxes within boxes all have their centres in
/// the middle of the longest sides.  Halved there, by nothing but their numbers, each half would fill the whole box again.
/// @param centre centre(item): a Vec3.
template <class Centre>
void halve_items(std::span<std::uint32_t> items, std::size_t left, const Centre& centre) {
  Box centres;
  for (const std::uint32_t item : items) centres.include(centre(item));
  const std::size_t axis = centres.longest_axis();
  std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(left), items.end(),
                   [&](std::uint32_t i, std::uint32_t j) {
                     return std::pair(centre(i)[axis], i) < std::pair(centre(j)[axis], j);
                   });
}

/// A balanced tree over numbered items, for trees of boxes.  Immutable after construction; queries from several threads
/// are safe.
template <class Bound>
class HalvedTree {
 public:
  HalvedTree() = default;

  /// O(N log N), on up to `threads` threads.
  /// @param bound_of bound_of(items): what some items lie in, a span of their numbers, one at least.
  /// @param centre centre(item): a Vec3, see halve_items().
  template <class BoundOf, class Centre>
  HalvedTree(std::vector<std::uint32_t> items, unsigned threads, const BoundOf& bound_of,
             const Centre& centre)
      : items_(std::move(items)) {
    const auto count = static_cast<std::uint32_t>(items_.size());
    if (count == 0) return;
    nodes_.resize(halving_nodes(count, kLeafItems));
    build(0, 0, count, threads, bound_of, centre);
  }

  /// Calls visit(item) for the items > `above` of all leaves that are reached, in an order of the tree's own.  A node is
  /// reached when enter(bound) is true for it and for all nodes above it.
  template <class Enter, class Visit>
  void visit_above(std::int64_t above, const Enter& enter, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::uint32_t, 64> stack;  // the tree is balanced: at most 32 levels
    std::size_t depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const std::uint32_t index = stack[--depth];
      const Node& node = nodes_[index];
      if (!(node.max_item > above && enter(node.bound))) continue;
      if (node.right != 0) {
        stack[depth++] = node.right;
        stack[depth++] = index + 1;
        continue;
      }
      for (std::uint32_t at = node.first; at < node.first + node.count; ++at)
        if (items_[at] > above) visit(items_[at]);
    }
  }

  /// Calls visit(item) for the items of all leaves whose bounds are nearer than `least`, nearer ones first.  What is
  /// visited may lower that.
  /// @param distance distance(bound): of all that lies in it at least that, and of a part of it no less.
  template <class Distance, class Visit>
  void visit_nearest(const Distance& distance, const double& least, const Visit& visit) const {
    if (nodes_.empty()) return;
    std::array<std::pair<double, std::uint32_t>, 64> stack;
    std::size_t depth = 0;
    stack[depth++] = {-std::numeric_limits<double>::infinity(), 0};
    while (depth > 0) {
      const auto [away, index] = stack[--depth];
      if (!(away < least)) continue;
      const Node& node = nodes_[index];
      if (node.right == 0) {
        for (std::uint32_t at = node.first; at < node.first + node.count; ++at) visit(items_[at]);
        continue;
      }
      std::pair near{distance(nodes_[index + 1].bound), index + 1};
      std::pair far{distance(nodes_[node.right].bound), node.right};
      if (far.first < near.first) std::swap(near, far);
      stack[depth++] = far;
      stack[depth++] = near;
    }
  }

 private:
  static constexpr std::uint32_t kLeafItems = 4;  // at most, of a leaf

  // Of items_[first, first + count).  Its left half is the next node.
  struct Node {
    Bound bound;
    std::uint32_t first, count;
    std::uint32_t right;     // half; 0 of a leaf
    std::uint32_t max_item;  // the largest number
  };

  template <class BoundOf, class Centre>
  void build(std::uint32_t index, std::uint32_t first, std::uint32_t count, unsigned threads,
             const BoundOf& bound_of, const Centre& centre) {
    const std::span items(items_.data() + first, count);
    nodes_[index] = {bound_of(items), first, count, 0, *std::max_element(items.begin(), items.end())};
    if (count <= kLeafItems) return;
    const std::uint32_t left = count / 2, right = index + 1 + halving_nodes(left, kLeafItems);
    halve_items(items, left, centre);
    nodes_[index].right = right;
    parallel_halves(
        threads, [&](unsigned share) { build(index + 1, first, left, share, bound_of, centre); },
        [&](unsigned share) { build(right, first + left, count - left, share, bound_of, centre); });
  }

  std::vector<std::uint32_t> items_;
  std::vector<Node> nodes_;  // the root first
};

}  // namespace affskel::core

#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/base/parallel.h"
#include "core/mesh/box.h"

// What the balanced trees of boxes have in common.  Their nodes lie in one array, the root first; a node
// covers the items [first, first + count), its left half is the next node, its right half the node `right`, 0
// for a leaf.  See halving_nodes for their number.

namespace affskel::core {

inline constexpr std::uint32_t kLeafItems = 4;  ///< at most, of a leaf

/// Calls `visit(position)` for the items of all leaves that are reached, by their position in the order of
/// the leaves.  A node is reached when `enter(node)` is true for it and for all nodes above it.
template <class Node, class Enter, class Visit>
void walk_halved_nodes(const std::vector<Node>& nodes, Enter enter, Visit visit) {
  if (nodes.empty()) return;
  std::array<std::uint32_t, 64> stack;  // the tree is balanced: at most 32 levels
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t index = stack[--depth];
    const Node& node = nodes[index];
    if (!enter(node)) continue;
    if (node.right != 0) {
      stack[depth++] = node.right;
      stack[depth++] = index + 1;
      continue;
    }
    for (std::uint32_t at = node.first; at < node.first + node.count; ++at) visit(at);
  }
}

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

/// Splits the items of nodes[index], whose members but `right` are set, by halve_items(), and calls
/// `build(index, first, count, threads)` for both halves, at the same time when `threads` > 1.
template <class Node, class Centre, class Build>
void halve_node(std::vector<Node>& nodes, std::uint32_t index, std::span<std::uint32_t> items,
                unsigned threads, const Centre& centre, Build build) {
  const std::uint32_t first = nodes[index].first, count = nodes[index].count, left = count / 2;
  halve_items(items.subspan(first, count), left, centre);
  const std::uint32_t right = index + 1 + halving_nodes(left, kLeafItems);
  nodes[index].right = right;
  parallel_halves(
      threads, [&](unsigned share) { build(index + 1, first, left, share); },
      [&](unsigned share) { build(right, first + left, count - left, share); });
}

}  // namespace affskel::core

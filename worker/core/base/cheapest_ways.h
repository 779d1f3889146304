#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/none.h"

namespace affskel::core {

/// The cheapest way from every node of a graph to one of several sources, from all of them at once (Dijkstra
/// 1959).  Of equally cheap ways the first one found stays: nodes are left by cost, then by number.
struct CheapestWays {
  std::vector<std::uint32_t> source;  ///< per node: name of the source, kNone where no way leads to one
  std::vector<double> cost;           ///< per node: of its way; infinity where there is none
  std::vector<std::uint32_t> step;  ///< per node: the last step to it, as `steps` names it; kNone in a source

  /// @param sources per node: the name of the source that it belongs to, or kNone.
  explicit CheapestWays(std::vector<std::uint32_t> sources)
      : source(std::move(sources)),
        cost(source.size(), std::numeric_limits<double>::infinity()),
        step(source.size(), kNone) {
    for (std::size_t node = 0; node < source.size(); ++node)
      if (source[node] != kNone) cost[node] = 0;
  }

  /// Finds the ways.
  /// @param steps steps(node, go) calls go(to, cost, name) for every step from a node, costs >= 0.  Mostly a
  ///   step's name is the node that it leaves.
  template <class Steps>
  void find(const Steps& steps) {
    using Item = std::pair<double, std::uint32_t>;
    std::priority_queue<Item, std::vector<Item>, std::greater<>> front;
    for (std::uint32_t node = 0; node < source.size(); ++node)
      if (source[node] != kNone) front.push({0, node});
    while (!front.empty()) {
      const double reached = front.top().first;
      const std::uint32_t node = front.top().second;
      front.pop();
      if (reached > cost[node]) continue;
      steps(node, [&](std::uint32_t to, double further, std::uint32_t name) {
        const double there = reached + further;
        if (!(there < cost[to])) return;
        cost[to] = there;
        source[to] = source[node];
        step[to] = name;
        front.push({there, to});
      });
    }
  }
};

/// The cheapest of some joins, in order, as far as they join what is not joined yet: with all of them taken,
/// a minimum spanning forest (Kruskal 1956).  With the joins over single steps between the realms of
/// CheapestWays, it spans the sources at the least cost of whole ways (Mehlhorn 1988).
/// @param joins in the order of <; equal ones as they come.
/// @param ends ends(join): the two that it joins, members of `sets`.
/// @param take take(join): whether it is taken, asked only where it joins; taken ones are united.
template <class Join, class Ends, class Take>
void take_cheapest(std::vector<Join> joins, DisjointSets& sets, const Ends& ends, const Take& take) {
  std::stable_sort(joins.begin(), joins.end());
  for (const Join& join : joins) {
    const auto [a, b] = ends(join);
    if (sets.find(a) != sets.find(b) && take(join)) sets.unite(a, b);
  }
}

}  // namespace affskel::core

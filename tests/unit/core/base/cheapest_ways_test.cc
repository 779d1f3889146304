#include "core/base/cheapest_ways.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace affskel::core {
namespace {

struct Edge {
  double cost;
  std::uint32_t a, b;
  friend auto operator<=>(const Edge&, const Edge&) = default;
};

constexpr std::uint32_t kNodes = 9;

// Costs are whole numbers: sums are exact in any order.
std::vector<Edge> random_graph(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<Edge> edges;
  for (int n = 0; n < 14; ++n) {
    const auto a = static_cast<std::uint32_t>(random() % kNodes),
               b = static_cast<std::uint32_t>(random() % kNodes);
    if (a != b) edges.push_back({static_cast<double>(random() % 5), a, b});
  }
  return edges;
}

auto steps_of(const std::vector<Edge>& edges) {
  return [&edges](std::uint32_t node, const auto& go) {
    for (const Edge& e : edges) {
      if (e.a == node) go(e.b, e.cost, node);
      if (e.b == node) go(e.a, e.cost, node);
    }
  };
}

// Bellman and Ford's: rounds over all edges until nothing changes.
std::vector<double> costs_by_rounds(const std::vector<Edge>& edges,
                                    const std::vector<std::uint32_t>& sources) {
  std::vector<double> cost(kNodes, HUGE_VAL);
  for (std::size_t node = 0; node < kNodes; ++node)
    if (sources[node] != kNone) cost[node] = 0;
  for (std::uint32_t round = 0; round < kNodes; ++round) {
    for (const Edge& e : edges) {
      cost[e.b] = std::min(cost[e.b], cost[e.a] + e.cost);
      cost[e.a] = std::min(cost[e.a], cost[e.b] + e.cost);
    }
  }
  return cost;
}

TEST(CheapestWays, CostWhatRoundsOverAllEdgesGive) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const std::vector<Edge> edges = random_graph(seed);
    std::vector<std::uint32_t> sources(kNodes, kNone);
    sources[0] = 70;
    sources[seed % kNodes] = 71;
    CheapestWays ways(sources);
    ways.find(steps_of(edges));
    EXPECT_EQ(ways.cost, costs_by_rounds(edges, sources)) << seed;
    for (std::uint32_t node = 0; node < kNodes; ++node) {
      EXPECT_EQ(ways.source[node] == kNone, ways.cost[node] == HUGE_VAL);
      if (ways.step[node] == kNone) continue;
      EXPECT_EQ(ways.source[node], ways.source[ways.step[node]]);  // the step's name is where it leaves
      EXPECT_TRUE(std::any_of(edges.begin(), edges.end(), [&](const Edge& e) {
        return std::minmax(e.a, e.b) == std::minmax(node, ways.step[node]) &&
               ways.cost[ways.step[node]] + e.cost == ways.cost[node];
      }));
    }
  }
}

// The least cost of all sets of edges that join as much as all edges do.
double least_forest(const std::vector<Edge>& edges) {
  const auto pieces = [&](std::uint32_t chosen) {
    DisjointSets sets(kNodes);
    std::uint32_t count = kNodes;
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (chosen >> e & 1U) count -= sets.unite(edges[e].a, edges[e].b) ? 1 : 0;
    return count;
  };
  const std::uint32_t all = (1U << edges.size()) - 1, wanted = pieces(all);
  double least = HUGE_VAL;
  for (std::uint32_t chosen = 0; chosen <= all; ++chosen) {
    double cost = 0;
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (chosen >> e & 1U) cost += edges[e].cost;
    if (cost < least && pieces(chosen) == wanted) least = cost;
  }
  return least;
}

constexpr auto ends_of = [](const Edge& e) { return std::pair{e.a, e.b}; };

TEST(TakeCheapest, SpansAllAtTheLeastCost) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const std::vector<Edge> edges = random_graph(seed);
    DisjointSets sets(kNodes);
    double cost = 0;
    take_cheapest(edges, sets, ends_of, [&](const Edge& e) {
      cost += e.cost;
      return true;
    });
    EXPECT_EQ(cost, least_forest(edges)) << seed;
    for (const Edge& e : edges) EXPECT_EQ(sets.find(e.a), sets.find(e.b));
  }
}

TEST(TakeCheapest, WhatIsNotTakenJoinsNothing) {
  DisjointSets sets(3);
  std::vector<double> asked;
  take_cheapest(std::vector<Edge>{{3, 0, 1}, {1, 0, 1}, {2, 1, 2}, {4, 0, 2}}, sets, ends_of,
                [&](const Edge& e) {
                  asked.push_back(e.cost);
                  return e.cost > 1;
                });
  EXPECT_EQ(asked, (std::vector<double>{1, 2, 3}));  // 4 would close a ring
}

}  // namespace
}  // namespace affskel::core

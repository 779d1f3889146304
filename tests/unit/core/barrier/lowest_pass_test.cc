#include "core/barrier/lowest_pass.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

#include "core/base/disjoint_sets.h"
#include "core/mesh/geodesic_sphere.h"

namespace affskel::core {
namespace {

const Mesh kSphere = geodesic_sphere(6);

std::vector<float> random_values(std::uint64_t seed, int levels) {
  std::mt19937_64 random(seed);
  std::vector<float> values;
  for (std::size_t v = 0; v < kSphere.points.size(); ++v)
    values.push_back(static_cast<float>(random() % static_cast<std::uint64_t>(levels)));
  return values;
}

// Vertices added in the order of their values, until both lie in one set.
float by_union_find(const std::vector<float>& values, std::uint32_t from, std::uint32_t to) {
  std::vector<std::uint32_t> order(values.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return values[a] < values[b]; });
  DisjointSets sets(values.size());
  std::vector<bool> there(values.size(), false);
  for (const std::uint32_t v : order) {
    there[v] = true;
    for (const Triangle& t : kSphere.triangles) {
      if (t[0] != v && t[1] != v && t[2] != v) continue;
      for (const std::uint32_t other : t) {
        if (there[other]) sets.unite(v, other);
      }
    }
    if (there[from] && there[to] && sets.find(from) == sets.find(to)) return values[v];
  }
  return -1;
}

TEST(Neighbours, OfASphereHasFiveOrSixNeighbours) {
  const Adjacency graph = neighbours(kSphere.points.size(), kSphere.triangles);
  ASSERT_EQ(graph.size(), kSphere.points.size());
  std::size_t fives = 0, pairs = 0;
  for (std::uint32_t v = 0; v < graph.size(); ++v) {
    const auto near = graph[v];
    EXPECT_TRUE(near.size() == 5 || near.size() == 6);
    fives += near.size() == 5;
    pairs += near.size();
    for (const std::uint32_t w : near) {
      EXPECT_LT(norm(kSphere.points[v] - kSphere.points[w]), 0.25);
      EXPECT_TRUE(std::ranges::count(graph[w], v) == 1);
    }
  }
  EXPECT_EQ(fives, 12U);
  EXPECT_EQ(pairs, 3 * kSphere.triangles.size());
}

TEST(LowestPass, IsWhereSublevelSetsJoin) {
  const Adjacency graph = neighbours(kSphere.points.size(), kSphere.triangles);
  LowestPass pass(graph);
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    // Few levels: many are equal.
    const std::vector<float> values = random_values(seed, seed % 2 == 0 ? 7 : 100000);
    const auto from = static_cast<std::uint32_t>(seed * 11), to = static_cast<std::uint32_t>(361 - seed * 5);
    const float level = pass.between(values, from, to);
    EXPECT_EQ(level, by_union_find(values, from, to));
    EXPECT_EQ(level, pass.between(values, to, from));
    EXPECT_EQ(pass.between(values, from, from), values[from]);
  }
}

TEST(MinimumBelow, IsLowerThanItsNeighbours) {
  const Adjacency graph = neighbours(kSphere.points.size(), kSphere.triangles);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const std::vector<float> values = random_values(seed, seed % 2 == 0 ? 3 : 100000);
    for (std::uint32_t v = 0; v < graph.size(); v += 13) {
      const std::uint32_t least = minimum_below(graph, values, v);
      for (const std::uint32_t near : graph[least]) EXPECT_LE(values[least], values[near]);
      EXPECT_LE(values[least], values[v]);
      EXPECT_EQ(minimum_below(graph, values, least), least);
    }
  }
}

// A height has one minimum, whatever one starts from.
TEST(MinimumBelow, OfAHeightIsItsLowestPoint) {
  const Adjacency graph = neighbours(kSphere.points.size(), kSphere.triangles);
  std::vector<float> height;
  for (const Vec3& p : kSphere.points) height.push_back(static_cast<float>(dot(p, {0.3, -0.5, 0.81})));
  const auto lowest = static_cast<std::uint32_t>(std::ranges::min_element(height) - height.begin());
  for (std::uint32_t v = 0; v < graph.size(); ++v) EXPECT_EQ(minimum_below(graph, height, v), lowest);
}

}  // namespace
}  // namespace affskel::core

// Lines that are known: two balls meet in one circle, a ball and a rod through it in two.
#include "core/infimum/crossing_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "core/mesh/mesh_topology.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

using Pair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<CrossingPair> linked(const Solid& solid) {
  HalfEdges mates;
  EXPECT_TRUE(find_mates_if_closed(solid.mesh, 1, mates));
  std::vector<Pair> pairs = solid.crossings;
  std::ranges::reverse(pairs);  // any order will do
  return link_crossings(solid.mesh, mates, pairs);
}

void expect_lines(const Mesh& mesh, int lines) {
  const Solid solid = make_solid(mesh);
  ASSERT_FALSE(solid.crossings.empty());
  const std::vector<CrossingPair> pairs = linked(solid);
  std::set<Pair> once;
  int begin = 0;
  for (const CrossingPair& pair : pairs) {
    EXPECT_TRUE(once.insert(std::minmax(pair.first, pair.second)).second);
    if (pair.links[0] == kNone) {
      ++begin;
      continue;
    }
    EXPECT_NE(pair.links[0], pair.links[1]);  // no corner is shared
    for (const std::uint32_t link : pair.links) EXPECT_TRUE(uses(solid.mesh.triangles[pair.second], link));
    // Across the edge is a triangle that passes through the same one.
    EXPECT_TRUE(std::ranges::any_of(solid.crossings, [&](const Pair& other) {
      const bool is_first = other.first == pair.first;
      if (!is_first && other.second != pair.first) return false;
      const std::uint32_t before = is_first ? other.second : other.first;
      const Triangle& corners = solid.mesh.triangles[before];
      return before != pair.second && uses(corners, pair.links[0]) && uses(corners, pair.links[1]);
    }));
  }
  EXPECT_EQ(once, (std::set<Pair>(solid.crossings.begin(), solid.crossings.end())));
  EXPECT_EQ(begin, lines);
}

TEST(CrossingLinksTest, TwoBallsMeetInOneLine) {
  expect_lines(joined(shaken(make_sphere(1, 320), 0, 1), moved(make_sphere(1, 500), {1.2, 0.1, 0.05})), 1);
}

TEST(CrossingLinksTest, ABallAndARodInTwo) {
  expect_lines(joined(make_sphere(1, 320), moved(make_box(4, 0.3, 0.2), {-2, -0.11, -0.07})), 2);
}

TEST(CrossingLinksTest, OfNothingThereAreNone) {
  EXPECT_TRUE(linked(make_solid(make_box(1, 2, 3))).empty());
}

}  // namespace
}  // namespace affskel::core

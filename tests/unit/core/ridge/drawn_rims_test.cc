#include "core/ridge/drawn_rims.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {
namespace {

// Vertices (i, j, 0) of a square grid, i and j from 0 to 2, whose strength falls as 1 / (i + 1) or is given.
struct Grid {
  std::vector<SheetVertex> vertices{9};
  std::vector<std::array<std::uint32_t, 4>> rings;
  Adjacency rim;

  Grid() {
    std::vector<Segment> edges;
    for (std::uint32_t n = 0; n < 9; ++n) {
      vertices[n].position = {double(n % 3), double(n / 3), 0};
      vertices[n].normal_a = {0, 0, 1};
      vertices[n].normal_b = {0, 0, -1};
      vertices[n].strength = 12 / (1.0 + n % 3);
    }
    for (const std::uint32_t n : {0U, 1U, 3U, 4U}) rings.push_back({n, n + 1, n + 4, n + 3});
    for (const auto& [a, b] : {Segment{0, 1}, {1, 2}, {2, 5}, {5, 8}, {8, 7}, {7, 6}, {6, 3}, {3, 0}})
      edges.push_back({a, b});
    rim = neighbours(9, edges);
  }
};

// 1 / strength is linear along x: it is low where that is.
TEST(DrawnRims, LieWhereTheStrengthIsLow) {
  const Grid grid;
  const std::vector<SheetVertex> drawn = drawn_rims(grid.vertices, grid.rings, grid.rim, 5);
  for (std::uint32_t n = 0; n < 9; ++n) {
    const bool weak = n % 3 == 2;  // 4 there
    EXPECT_NEAR(drawn[n].position.x, weak ? 12 / 5.0 - 1 : n % 3, 1e-12) << n;
    EXPECT_EQ(drawn[n].position.y, n / 3) << n;
    EXPECT_EQ(drawn[n].strength, weak ? 5 : grid.vertices[n].strength) << n;
  }
}

// The middle is on no rim; a corner with two weak neighbours goes across its square; a membrane has no strength.
TEST(DrawnRims, AreOfTheRidgeAlone) {
  Grid grid;
  for (SheetVertex& vertex : grid.vertices) vertex.strength = 12;
  grid.vertices[4].strength = 3;
  for (const std::uint32_t n : {1U, 2U, 5U}) grid.vertices[n].strength = 3;
  grid.vertices[8].strength = 0;
  grid.vertices[8].kind = SkeletonKind::kMembrane;
  std::vector<SheetVertex> drawn = drawn_rims(grid.vertices, grid.rings, grid.rim, 6);
  EXPECT_EQ(drawn[4].position, grid.vertices[4].position);
  EXPECT_EQ(drawn[2].position, grid.vertices[2].position) << "all of its square are weak";
  EXPECT_EQ(drawn[8].position, grid.vertices[8].position);
  EXPECT_LT(drawn[1].position.x, 1);
  grid.vertices[4].strength = 12;
  drawn = drawn_rims(grid.vertices, grid.rings, grid.rim, 6);
  EXPECT_NEAR(drawn[2].position.x, 2 - 2 / 3.0, 1e-12);
  EXPECT_NEAR(drawn[2].position.y, 2 / 3.0, 1e-12);
}

// Each pass draws a vertex half-way to the mean of its neighbours.
TEST(RimPasses, LeaveRingsMostOfTheirSize) {
  for (std::uint32_t n = 4; n <= 40; ++n) {
    std::vector<Segment> ring;
    std::vector<Vec3> at;
    for (std::uint32_t v = 0; v < n; ++v) {
      ring.push_back({v, (v + 1) % n});
      at.push_back({std::cos(2 * std::numbers::pi * v / n), std::sin(2 * std::numbers::pi * v / n), 0});
    }
    const std::vector<int> passes = rim_passes(neighbours(n, ring), 24);
    for (int pass = 0; pass < passes[0]; ++pass) {
      const std::vector<Vec3> before = at;
      for (std::uint32_t v = 0; v < n; ++v)
        at[v] = 0.5 * before[v] + 0.25 * (before[(v + 1) % n] + before[(v + n - 1) % n]);
    }
    EXPECT_GE(norm(at[0]), 0.72) << n;
    EXPECT_LE(norm(at[0]), n < 12 ? 1 : n <= 28 ? 0.78 : 0.95) << n;
    EXPECT_EQ(passes, std::vector<int>(n, passes[0])) << n;
  }
}

TEST(RimPasses, AreAsManyAsAskedOnLongRims) {
  std::vector<Segment> edges;  // of 6 and of 40, and a vertex on none
  for (std::uint32_t v = 0; v < 6; ++v) edges.push_back({v, (v + 1) % 6});
  for (std::uint32_t v = 0; v < 40; ++v) edges.push_back({6 + v, 6 + (v + 1) % 40});
  const std::vector<int> passes = rim_passes(neighbours(47, edges), 24);
  EXPECT_EQ(passes[0], 1);
  EXPECT_EQ(passes[6], 24);
  EXPECT_EQ(passes[46], 0);
}

}  // namespace
}  // namespace affskel::core

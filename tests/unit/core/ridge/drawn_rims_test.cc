#include "core/ridge/drawn_rims.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
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

}  // namespace
}  // namespace affskel::core

#include "core/collapse/shortest_loops.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/collapse/collapse.h"
#include "core/collapse/lattice_solids.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// The lengths of the loops of a solid, in edges.
std::vector<std::size_t> lengths(const Mesh& mesh, double spacing, std::size_t count) {
  const LatticeSolid solid(mesh, spacing);
  const DualComplex complex(solid.lattice);
  std::vector<std::size_t> result;
  for (const auto& loop : shortest_loops(complex, collapse(complex, {}).cells, count))
    result.push_back(loop.edges.size());
  return result;
}

// A closed way of lattice edges about a circle is at least its four quarters' straight sides, twice the diameter.
TEST(ShortestLoops, OfARingIsOneAllRound) {
  const auto ring = lengths(make_torus(2, 0.5, 1024), 0.1, 9);
  ASSERT_EQ(ring.size(), 1U);
  EXPECT_GE(ring[0], static_cast<std::size_t>(8 * 1.5 / 0.1));
  EXPECT_LE(ring[0], static_cast<std::size_t>(8 * 2.5 / 0.1));
  EXPECT_TRUE(lengths(make_sphere(1, 320), 0.15, 9).empty());
}

TEST(ShortestLoops, BeginWithTheSmallest) {
  const Mesh rings = joined(make_torus(2, 0.4, 1024), moved(make_torus(1, 0.4, 1024), {3, 0, 0}));
  const auto both = lengths(rings, 0.11, 9);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_LT(both[0], both[1]);
  EXPECT_EQ(lengths(rings, 0.11, 1), std::vector<std::size_t>{both[0]});
}

TEST(ShortestLoops, LeadAlongTheirEdges) {
  const LatticeSolid solid(joined(make_torus(2, 0.4, 1024), moved(make_torus(1, 0.4, 1024), {3, 0, 0})),
                           0.11);
  const DualComplex complex(solid.lattice);
  const CellSet left = collapse(complex, {}).cells;
  for (const auto& [vertices, edges] : shortest_loops(complex, left, 9)) {
    ASSERT_EQ(edges.size(), vertices.size());
    for (std::size_t n = 0; n < edges.size(); ++n) {
      EXPECT_TRUE(left.has(edges[n]) && is_bare(complex, edges[n], left));
      auto ends = complex.ends(edges[n]);
      if (ends[0] != vertices[n]) std::swap(ends[0], ends[1]);
      EXPECT_EQ(ends, (std::array{vertices[n], vertices[(n + 1) % vertices.size()]}));
    }
  }
}

// Without cavities what is left is a graph, and its cycles are the tunnels.
TEST(ShortestLoops, AreAsManyAsTunnels) {
  std::size_t compared = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.17);
    const DualComplex complex(solid.lattice);
    const BettiNumbers betti = betti_numbers(complex);
    if (betti.cavities > 0) continue;
    EXPECT_EQ(shortest_loops(complex, collapse(complex, {}).cells, 1000).size(), betti.holes) << seed;
    compared += betti.holes > 0;
  }
  EXPECT_GT(compared, 10U);
}

}  // namespace
}  // namespace affskel::core

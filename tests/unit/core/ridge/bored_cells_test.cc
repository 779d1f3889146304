#include "core/ridge/bored_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/collapse/collapse.h"
#include "core/collapse/lattice_solids.h"
#include "core/ridge/local_depth.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

// A solid that counts as noisy, as thick all over as is said.
struct Noisy {
  LatticeSolid solid;
  DualComplex complex{solid.lattice};
  std::vector<float> radius = surface_distance(solid.lattice), thickness;
  CellSet left = collapse(complex, {}).cells;

  Noisy(const Mesh& mesh, double spacing, float thick)
      : solid(mesh, spacing), thickness(solid.lattice.points, thick) {}
  NoisySolid all(std::uint64_t handles = 0) const {
    return {solid.lattice, complex, radius, thickness, handles};
  }
};

// The loop left of it is about 12 spacings across.
Mesh ring() {
  return make_torus(1.2, 0.4, 1024);
}

TEST(BoredCells, AreAnEdgeOfALoopWithinALimb) {
  const Noisy noisy(ring(), 0.2, 7);
  const std::vector<Cell> cells = bored_cells(noisy.all(), noisy.left).cells;
  ASSERT_EQ(cells.size(), 1U);
  EXPECT_EQ(DualComplex::dimension(cells[0]), 1);
  EXPECT_TRUE(noisy.left.has(cells[0]));
}

TEST(BoredCells, LeaveHandlesAndLoopsBetweenLimbsAndWhatIsKept) {
  const Noisy thick(ring(), 0.2, 7), thin(ring(), 0.2, 3);
  EXPECT_TRUE(bored_cells(thick.all(1), thick.left).cells.empty());
  EXPECT_TRUE(bored_cells(thin.all(), thin.left).cells.empty());
  std::vector<Anchor> all;
  thick.left.for_each([&](Cell cell) { all.push_back({cell, 0}); });
  EXPECT_TRUE(bored_cells(thick.all(), thick.left, all).cells.empty());
}

TEST(BoredCells, AreASquareOfAMembrane) {
  const Noisy noisy(hollow_ball(), 0.4, 7);
  const std::vector<Cell> cells = bored_cells(noisy.all(), noisy.left).cells;
  ASSERT_EQ(cells.size(), 1U);
  EXPECT_EQ(DualComplex::dimension(cells[0]), 2);
}

// Of an eight, whose loops share a place, and of a shell.
TEST(BoredCells, FillAllTunnelsAndVoids) {
  const Mesh eight = joined(ring(), moved(ring(), {2.1, 0, 0}));
  for (const Mesh& mesh : {eight, hollow_ball()}) {
    Noisy noisy(mesh, 0.2, 40);
    const BettiNumbers before = betti_numbers(noisy.complex);
    ASSERT_GT(before.holes + before.cavities, 0U);
    EXPECT_EQ(fill_bored(noisy.all(), before, {}, noisy.left), (BettiNumbers{before.components, 0, 0}));
    std::size_t cells = 0;
    noisy.left.for_each([&](Cell) { ++cells; });
    EXPECT_EQ(cells, 1U) << "a vertex: nothing is anchored";
  }
}

}  // namespace
}  // namespace affskel::core

#include "core/collapse/dual_complex.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/chords/chord_fields.h"
#include "core/collapse/lattice_solids.h"
#include "core/quality/voxel_topology.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

TEST(DualComplex, OfABoxHasTheCellsOfItsCubes) {
  const BoxLattice box(3, 4, 5);
  ASSERT_EQ(box.lattice.points, 60U);
  const DualComplex complex(box.lattice);
  std::array<int, 4> count{};
  complex.for_each_cell([&](Cell cell) { ++count[static_cast<std::size_t>(DualComplex::dimension(cell))]; });
  EXPECT_EQ(count[3], 60);
  EXPECT_EQ(count[0], 4 * 5 * 6);
  EXPECT_EQ(count[2], 4 * 4 * 5 + 3 * 5 * 5 + 3 * 4 * 6);
  EXPECT_EQ(count[1], 3 * 5 * 6 + 4 * 4 * 6 + 4 * 5 * 5);
}

// A cell has one name, whichever of its cubes it is asked for from; faces and cofaces are each other's.
TEST(DualComplex, NamesCellsAlikeFromAllTheirCubes) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.15);
    const DualComplex complex(solid.lattice);
    complex.for_each_cell([&](Cell cell) {
      std::set<std::uint32_t> cubes;
      for (const auto& [cube, place] : complex.star(cell)) {
        EXPECT_EQ(complex.cell(cube, place), cell);
        cubes.insert(cube);
      }
      EXPECT_EQ(cubes.size(), complex.star(cell).count);
      const auto cofaces = complex.cofaces(cell);
      EXPECT_EQ(std::set<Cell>(cofaces.begin(), cofaces.end()).size(), cofaces.count);
      EXPECT_EQ(complex.coface_count(cell), cofaces.count);
      for (std::uint32_t n = 0; n < cofaces.count; ++n)
        EXPECT_EQ(complex.face(cofaces.cells[n], cofaces.sides[n]), cell);
      for (const Cell coface : cofaces) {
        int met = 0;
        complex.for_each_face(coface, [&](Cell face) { met += face == cell; });
        EXPECT_EQ(met, 1);
      }
      complex.for_each_face(cell, [&](Cell face) {
        const auto back = complex.cofaces(face);
        EXPECT_NE(std::find(back.begin(), back.end(), cell), back.end());
      });
    });
  }
}

TEST(DualComplex, OwnsEachCellOnce) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.15);
    const DualComplex complex(solid.lattice);
    for (std::uint32_t cube = 0; cube < complex.cubes(); ++cube) {
      for (std::uint32_t place = 0; place < 27; ++place) {
        std::uint32_t lowest = cube;
        for (const auto& member : complex.star(DualComplex::name(cube, place)))
          lowest = std::min(lowest, member.cube);
        EXPECT_EQ(DualComplex::cube_of(complex.cell(cube, place)), lowest);
        EXPECT_EQ(complex.is_own(cube, place), lowest == cube);
      }
    }
  }
}

TEST(DualComplex, HasTheBettiNumbersOfTheSolid) {
  const auto of = [](const Mesh& mesh, double spacing) {
    return betti_numbers(DualComplex(LatticeSolid(mesh, spacing).lattice));
  };
  EXPECT_EQ(of(make_sphere(1, 320), 0.13), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(of(make_torus(3, 1, 512), 0.3), (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(of(hollow_ball(), 0.3), (BettiNumbers{1, 0, 1}));
  EXPECT_EQ(of(cup(32), 0.2), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(of(joined(make_torus(3, 1, 512), moved(hollow_ball(), {9, 0, 0})), 0.3), (BettiNumbers{2, 1, 1}));
  // A ball in the cavity of another: its void is theirs, not a piece of both.
  EXPECT_EQ(of(joined(hollow_ball(), moved(make_sphere(0.6, 320), {0.5, 0, 0})), 0.15),
            (BettiNumbers{2, 0, 1}));
}

// Two boxes closer than a spacing stand on neighbouring sample points, which are not glued.
TEST(DualComplex, IsPartedByAGapThinnerThanASpacing) {
  const Mesh box = make_box(1, 1, 1);
  const LatticeSolid both(joined(box, moved(box, {1.02, 0, 0})), 0.101);
  const DualComplex complex(both.lattice);
  EXPECT_EQ(betti_numbers(complex), (BettiNumbers{2, 0, 0}));
  std::vector<std::uint32_t> ranks(both.lattice.points);
  for (std::uint32_t p = 0; p < ranks.size(); ++p) ranks[p] = p;
  EXPECT_EQ(voxel_betti_numbers(lattice_places(both.lattice, ranks)).components, 1U);
}

}  // namespace
}  // namespace affskel::core

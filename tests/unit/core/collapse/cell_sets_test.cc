#include "core/collapse/cell_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "core/collapse/lattice_solids.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

TEST(CellValues, AreOneForEachCell) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.15);
    const DualComplex complex(solid.lattice);
    for (const std::uint32_t of : {DualComplex::kAllPlaces, DualComplex::places_of_dimension(0),
                                   DualComplex::places_of_dimension(1)}) {
      CellValues<std::uint16_t> values(complex, of, 7);
      std::set<const std::uint16_t*> places;
      std::size_t cells = 0;
      complex.for_each_cell([&](DualComplex::Cell cell) {
        if ((of >> DualComplex::place_of(cell) & 1U) == 0) return;
        EXPECT_EQ(values[cell], 7);
        values[cell] = 1;
        places.insert(&values[cell]);
        ++cells;
      });
      EXPECT_EQ(places.size(), cells);
      std::size_t visited = 0;
      values.for_each([&](DualComplex::Cell cell, std::uint16_t& value) {
        EXPECT_EQ(&value, &values[cell]);
        visited += std::exchange(value, std::uint16_t{2}) == 1;
      });
      EXPECT_EQ(visited, cells) << "each once";
      EXPECT_EQ(std::ranges::max(places) - std::ranges::min(places) + 1, cells) << "there are no others";
    }
  }
}

TEST(CellSet, IsClosedWithTheBoundariesOfItsCells) {
  const LatticeSolid solid(random_solid(1), 0.2);
  const DualComplex complex(solid.lattice);
  CellSet cells(complex);
  const DualComplex::Cell cube = DualComplex::name(0, DualComplex::kCube);
  insert_closed(complex, cube, cells);
  std::size_t count = 0, bare = 0;
  cells.for_each([&](DualComplex::Cell cell) {
    ++count;
    bare += is_bare(complex, cell, cells);
    complex.for_each_face(cell, [&](DualComplex::Cell face) { EXPECT_TRUE(cells.has(face)); });
  });
  EXPECT_EQ(count, 27U);
  EXPECT_EQ(bare, 1U) << "the cube alone bounds nothing";
}

TEST(WeakestCell, IsNearestToTheSurfaceOrTheFirst) {
  const LatticeSolid box(make_box(2, 1, 1), 0.4);
  const DualComplex complex(box.lattice);
  ASSERT_GE(complex.cubes(), 5U);
  std::vector<float> radius(complex.cubes(), 3);
  radius[1] = radius[3] = radius[4] = 1;
  radius[2] = 2;
  const auto middle = [](std::uint32_t cube) { return DualComplex::name(cube, DualComplex::kCube); };
  for (const auto& [cubes, weakest] : {std::pair(std::vector<std::uint32_t>{0, 2}, 2U),
                                       std::pair(std::vector<std::uint32_t>{0, 4, 1, 3, 2}, 1U)}) {
    WeakestCell found;
    EXPECT_FALSE(found.cell.has_value());
    for (const std::uint32_t cube : cubes) found.look_at(complex, radius, middle(cube));
    EXPECT_EQ(found.cell, middle(weakest));
  }
}

}  // namespace
}  // namespace affskel::core

#include "core/contour/edge_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <span>
#include <vector>

#include "core/base/error.h"
#include "core/chords/chord_fields.h"

namespace affskel::core {
namespace {

TEST(EdgeCells, AnEdgeHasFourCellsOnceRound) {
  const BoxLattice box(3, 3, 3);
  const std::vector<LatticeEdge> edges{{4, 1, {0, 1, 1}}};
  const EdgeCells cells =
      edge_cells(box.lattice, DualComplex(box.lattice), SolidParts(box.solid, box.lattice), edges);
  ASSERT_EQ(cells.size(), 4U);
  EXPECT_EQ(*std::min_element(cells.place.begin(), cells.place.end()), (CellPlace{-1, 1, 0}));
  EXPECT_EQ(*std::max_element(cells.place.begin(), cells.place.end()), (CellPlace{0, 1, 1}));
  EXPECT_EQ(std::count(cells.whole.begin(), cells.whole.end(), 1), 2);
  for (std::size_t corner = 0; corner < 4; ++corner) {
    const CellPlace &a = cells.place[cells.ring[0][corner]],
                    &b = cells.place[cells.ring[0][(corner + 1) % 4]];
    EXPECT_EQ(std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]), 1);
  }
}

TEST(EdgeCells, RefusesMoreEdgesThanCanBeNumbered) {
  const BoxLattice box(3, 3, 3);
  const LatticeEdge edge;
  const std::span<const LatticeEdge> many(&edge, std::size_t{1} << 30);
  try {
    edge_cells(box.lattice, DualComplex(box.lattice), SolidParts(box.solid, box.lattice), many);
    FAIL() << "not refused";
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kLimit);
  }
}

}  // namespace
}  // namespace affskel::core

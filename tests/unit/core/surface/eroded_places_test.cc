#include "core/surface/eroded_places.h"

#include <gtest/gtest.h>

#include <random>

#include "core/base/none.h"
#include "core/lattice/layer_index.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

struct Seen {
  std::size_t full = 0, gaps = 0, empty_rows = 0;
};

unsigned gaps_from(const LatticeCuts& cuts, std::int64_t i, std::int64_t j, std::int64_t k) {
  unsigned gaps = 0;
  for (unsigned step = 1; step < 8; ++step) {
    const LatticeCut* cut = cuts.find(cuts.edge(i, j, k, step));
    if (cut != nullptr && cut->gap) gaps |= 1U << step;
  }
  return gaps;
}

// One row against the definitions, place by place.
void expect_row(const ErodedPlaces::Row& row, std::int64_t i, std::int64_t j, const LayerIndex& ranks,
                const std::vector<double>& erosion, const LatticeCuts& cuts, const LatticeGrid& grid,
                Seen& seen) {
  ErodedPlaces::Extent extent;
  for (std::int64_t k = -1; k <= grid.dims[2]; ++k) {
    SCOPED_TRACE(testing::Message() << "place " << i << ' ' << j << ' ' << k);
    const std::uint32_t rank = ranks.at(i, j, k);
    const bool full = rank != kNone && erosion[rank] >= 1;
    EXPECT_EQ(row.full[k], full ? 1 : 0);
    if (full) extent.take(k, k);
    seen.full += full;
    if (i < 0 || i == grid.dims[0]) continue;
    const unsigned gaps = gaps_from(cuts, i, j, k);
    EXPECT_EQ(row.gaps[k], gaps);
    seen.gaps += gaps != 0;
  }
  EXPECT_EQ(row.extent.first, extent.first);
  EXPECT_EQ(row.extent.last, extent.last);
  seen.empty_rows += extent.first > extent.last;
}

// Prongs 1 apart leave gaps between sample points 0.7 apart.  The field is of ones and zeros at random, so
// that rows have holes and some are empty.
TEST(ErodedPlacesTest, TellFullPlacesAndGapsOfEveryPairOfLayers) {
  const Solid solid = make_solid(shaken(comb(15), 1e-3, 3));
  LatticeOptions options;
  options.spacing = 0.7;
  const Lattice lattice = make_lattice(solid, options);
  const LatticeCuts cuts(solid, lattice);
  FrameField field;
  std::mt19937_64 random(7);
  for (std::uint32_t p = 0; p < lattice.points; ++p) field.erosion.push_back(random() % 3 == 0 ? 1 : 0);

  ErodedPlaces places(lattice, field, cuts, 1);
  LayerIndex ranks(lattice);
  const auto dims = lattice.grid.dims;
  Seen seen;
  for (std::int64_t at = -1; at < dims[0]; ++at) {
    places.move_to(at);
    if (at + 1 < dims[0]) ranks.move_to(static_cast<std::uint32_t>(at + 1));
    for (std::int64_t i = at; i <= at + 1; ++i) {
      for (std::int64_t j = -1; j <= dims[1]; ++j) {
        expect_row(places.row(i, j), i, j, ranks, field.erosion, cuts, lattice.grid, seen);
      }
    }
  }
  EXPECT_GT(seen.full, 10U);
  EXPECT_GT(seen.gaps, 10U);
  EXPECT_GT(seen.empty_rows, 10U);
}

}  // namespace
}  // namespace affskel::core

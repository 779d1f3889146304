// Pieces that hold a place of greater E, against the pieces themselves.
#include "core/infimum/near_places.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/infimum/chord_piece.h"
#include "core/infimum/samples.h"
#include "core/lattice/lattice_edges.h"
#include "core/shapes/body.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

class NearPlacesTest : public testing::Test {
 protected:
  explicit NearPlacesTest(const Mesh& mesh = make_body({.triangles = 292}))
      : solid_(make_solid(mesh)),
        input_(solid_),
        lattice_(lattice_of_points(solid_, 1000)),
        places_(places_of(lattice_)),
        around_(lattice_.points),
        least_(lattice_.points) {
    for (auto& around : around_) around.fill(kNone);
    for_each_edge(lattice_, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto&) {
      around_[x][2 * axis] = y;
      around_[y][2 * axis + 1] = x;
    });
  }

  NearPlaces near(std::uint32_t p) const { return {lattice_.grid, around_, least_, p}; }

  Solid solid_;
  PieceInput input_;
  Lattice lattice_;
  std::vector<Vec3> places_;
  LatticeNeighbours around_;
  std::vector<LeastChord> least_;
  SplitMix64 random_{5};
};

TEST_F(NearPlacesTest, AreTwoStepsAway) {
  for (std::uint32_t p = 0; p < lattice_.points; ++p) {
    std::set<std::uint32_t> expected;
    for (const std::uint32_t q : around_[p]) {
      if (q == kNone) continue;
      expected.insert(q);
      expected.insert(around_[q].begin(), around_[q].end());
    }
    expected.erase(p);
    expected.erase(kNone);
    std::set<std::uint32_t> found;
    near(p).for_each([&](std::uint32_t q, const Vec3& way) {
      EXPECT_TRUE(found.insert(q).second);
      EXPECT_LT(norm(way - (places_[q] - places_[p])), 1e-12);
    });
    EXPECT_EQ(found, expected);
  }
}

// E in the place of the least of a few pieces: the rule holds whatever the planes are that E is the least of, so long
// as the one in question is among them at every place.
TEST_F(NearPlacesTest, APieceIsNoLessThanOnesThatItHolds) {
  PieceFinder finder(input_);
  std::size_t held = 0;
  for (int n = 0; n < 20; ++n) {
    const Vec3 d = draw_direction(random_);
    for (std::uint32_t p = 0; p < lattice_.points; ++p) least_[p].erosion = finder.find(places_[p], d).volume;
    for (std::uint32_t p = 0; p < lattice_.points; ++p) {
      // Below itself nothing is greater.
      EXPECT_FALSE(near(p).holds_more(d, least_[p].erosion * (1 + 1e-9) + 1e-12)) << p;
      held += near(p).holds_more(d, 0.5 * least_[p].erosion);
    }
  }
  EXPECT_GT(held, 1000U);
}

}  // namespace
}  // namespace affskel::core

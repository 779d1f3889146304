#include "core/chord_pruning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "chord_fields.h"
#include "core/error.h"

namespace affskel::core {
namespace {

// Shocks of the plane z = 1.5 in a box of 40 x 20 x 4 points, laid by hand.
class Plane {
 public:
  // Over 0 <= i - i0 < ni, 0 <= j - j0 < nj.
  void add(std::uint32_t i0, std::uint32_t ni, std::uint32_t j0, std::uint32_t nj, double opening,
           double strength = 1, double erosion = 100) {
    for (std::uint32_t i = i0; i < i0 + ni; ++i) {
      for (std::uint32_t j = j0; j < j0 + nj; ++j) {
        ChordShock shock;
        shock.place = {i, j, 1};
        shock.point = (i * 20 + j) * 4 + 1;
        shock.upper = shock.point + 1;
        shock.axis = 2;
        shock.position = {static_cast<double>(i), static_cast<double>(j), 1.5};
        shock.erosion = erosion;
        shock.strength = strength;
        shock.opening = opening;
        shock.gradient_low = {0, 0, 1};
        shock.gradient_high = {0, 0, -1};
        shocks_.push_back(shock);
      }
    }
  }

  SignificantShocks prune(const ChordPruningOptions& options = {}) {
    std::sort(shocks_.begin(), shocks_.end(),
              [](const ChordShock& a, const ChordShock& b) { return a.point < b.point; });
    return significant_shocks(box_.lattice, SolidParts(box_.solid, box_.lattice), shocks_, options);
  }

 private:
  BoxLattice box_{40, 20, 4};
  std::vector<ChordShock> shocks_;
};

bool keeps(const SignificantShocks& kept, std::uint32_t i, std::uint32_t j) {
  return std::any_of(kept.shocks.begin(), kept.shocks.end(),
                     [&](const ChordShock& s) { return s.place[0] == i && s.place[1] == j; });
}

ChordPruningOptions with_significance(double significance) {
  ChordPruningOptions options;
  options.significance = significance;
  return options;
}

TEST(SignificantShocks, APieceIsWeighedByAreaStrengthAndOpening) {
  Plane plane;
  plane.add(0, 10, 0, 10, 1);
  plane.add(30, 5, 0, 4, 0.3, 0.5);  // 20 * 0.15 = 3 against 100
  const SignificantShocks all = plane.prune(with_significance(0.029));
  ASSERT_EQ(all.pieces.size(), 2U);
  EXPECT_NEAR(all.pieces[0], 100.0 / 103, 1e-12);
  EXPECT_NEAR(all.pieces[1], 3.0 / 103, 1e-12);
  EXPECT_EQ(all.shocks.size(), 120U);
  EXPECT_EQ(all.bridges, 0U);
  const SignificantShocks large = plane.prune(with_significance(0.0292));
  EXPECT_EQ(large.pieces.size(), 1U);
  EXPECT_EQ(large.shocks.size(), 100U);
}

TEST(SignificantShocks, WeakShocksAloneAreDroppedAndCarryNoWeight) {
  Plane plane;
  plane.add(0, 3, 0, 3, 1);
  plane.add(20, 10, 0, 20, 0.24);
  const SignificantShocks kept = plane.prune(with_significance(0));
  EXPECT_EQ(kept.shocks.size(), 9U);
  EXPECT_EQ(kept.pieces, std::vector<double>{1.0});
}

TEST(SignificantShocks, DiagonalNeighboursTouch) {
  Plane plane;
  plane.add(0, 5, 0, 5, 1);
  plane.add(5, 5, 5, 5, 1);
  plane.add(20, 1, 5, 1, 1);
  EXPECT_EQ(plane.prune(with_significance(0)).pieces.size(), 2U);
}

// Between two pieces a weak field with a cheaper lane in row 3.
TEST(SignificantShocks, PiecesAreJoinedByTheCheapestWay) {
  Plane plane;
  plane.add(0, 5, 0, 8, 1);
  plane.add(15, 5, 0, 8, 0.5);
  plane.add(5, 10, 0, 3, 0.05);
  plane.add(5, 10, 3, 1, 0.1);
  plane.add(5, 10, 4, 4, 0.05);
  const SignificantShocks kept = plane.prune();
  EXPECT_EQ(kept.pieces.size(), 2U);  // 10 steps of cost 10: too far to be weighed as one
  EXPECT_EQ(kept.bridges, 1U);
  // Cells reach half a step beyond the pieces, so that a way need not step on every shock of the lane.
  for (std::uint32_t i = 6; i < 14; ++i) EXPECT_TRUE(keeps(kept, i, 3)) << i;
  EXPECT_FALSE(keeps(kept, 10, 6));
  EXPECT_LE(kept.shocks.size(), 90U);
  ChordPruningOptions options;
  options.near_cost = 101;
  EXPECT_EQ(plane.prune(options).pieces, std::vector<double>{1.0});
}

// A speck counts with the piece that it hangs on by a cheap way, but not with one far away.
TEST(SignificantShocks, NearPiecesAreWeighedAsOne) {
  Plane plane;
  plane.add(0, 10, 0, 20, 1);
  plane.add(12, 1, 10, 1, 0.25);
  plane.add(10, 2, 10, 1, 0.2);
  plane.add(30, 1, 10, 1, 0.25);
  plane.add(13, 17, 10, 1, 0.01);
  const SignificantShocks kept = plane.prune();
  EXPECT_TRUE(keeps(kept, 12, 10));
  EXPECT_TRUE(keeps(kept, 11, 10));
  EXPECT_FALSE(keeps(kept, 30, 10));
  EXPECT_FALSE(keeps(kept, 20, 10));
  EXPECT_EQ(kept.pieces.size(), 1U);
}

TEST(SignificantShocks, HolesAreFilledButNotTheRim) {
  Plane plane;
  plane.add(0, 9, 0, 4, 1);
  plane.add(0, 4, 4, 1, 1);
  plane.add(4, 1, 4, 1, 0.01);
  plane.add(5, 4, 4, 1, 1);
  plane.add(0, 9, 5, 4, 1);
  plane.add(0, 9, 9, 1, 0.01);
  const SignificantShocks kept = plane.prune();
  EXPECT_TRUE(keeps(kept, 4, 4));
  EXPECT_FALSE(keeps(kept, 4, 9));
  EXPECT_EQ(kept.shocks.size(), 81U);
}

// The volume is 40 * 20 * 4 = 3200, a thousandth of it 3.2.
TEST(SignificantShocks, WhereLittleIsCutOffNoShockIsStrong) {
  Plane plane;
  plane.add(0, 10, 0, 10, 1, 1, 3.3);
  plane.add(20, 10, 0, 10, 1, 1, 3.1);
  EXPECT_EQ(plane.prune().shocks.size(), 100U);
  ChordPruningOptions options;
  options.least_erosion = 0;
  EXPECT_EQ(plane.prune(options).shocks.size(), 200U);
}

TEST(SignificantShocks, NothingComesOfNothing) {
  Plane plane;
  EXPECT_TRUE(plane.prune().shocks.empty());
  EXPECT_TRUE(plane.prune().pieces.empty());
}

TEST(SignificantShocks, RefusesOptionsOutOfRange) {
  Plane plane;
  for (const ChordPruningOptions& options :
       {ChordPruningOptions{-1}, ChordPruningOptions{1.5}, ChordPruningOptions{std::nan("")},
        ChordPruningOptions{0, 2}, ChordPruningOptions{0, 0, -1}, ChordPruningOptions{0, 0, 0, -1}}) {
    EXPECT_THROW(plane.prune(options), CoreError);
  }
}

}  // namespace
}  // namespace affskel::core

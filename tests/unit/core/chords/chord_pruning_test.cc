#include "core/chords/chord_pruning.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "core/base/error.h"
#include "core/chords/chord_fields.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

struct Options : ChordConstants {
  double significance = 0.005;
};

// With turns of a quarter and more strong.
Options quarter() {
  Options options;
  options.strong_turn = 0.25;
  return options;
}

// Equal shocks over 0 <= i - i0 < ni, 0 <= j - j0 < nj.
struct Patch {
  std::uint32_t i0, ni, j0, nj;
  double turn, strength = 1, erosion = 100;
};

// Patches in the plane z = 1.5 of a box of 40 x 20 x 4 points.
class PrunedPlane {
 public:
  PrunedPlane(std::initializer_list<Patch> patches) {
    for (const Patch& patch : patches) add(patch);
    std::sort(shocks_.begin(), shocks_.end(),
              [](const ChordShock& a, const ChordShock& b) { return a.point < b.point; });
  }

  SignificantShocks prune(const Options& options = quarter()) const {
    return significant_shocks(box_.lattice, SolidParts(box_.solid, box_.lattice), shocks_,
                              options.significance, options);
  }

 private:
  void add(const Patch& patch) {
    for (std::uint32_t i = patch.i0; i < patch.i0 + patch.ni; ++i) {
      for (std::uint32_t j = patch.j0; j < patch.j0 + patch.nj; ++j) {
        ChordShock shock;
        shock.place = {i, j, 1};
        shock.point = (i * 20 + j) * 4 + 1;
        shock.upper = shock.point + 1;
        shock.axis = 2;
        shock.position = {static_cast<double>(i), static_cast<double>(j), 1.5};
        shock.erosion = patch.erosion;
        shock.strength = patch.strength;
        shock.turn = patch.turn;
        shock.gradient_low = {0, 0, 1};
        shock.gradient_high = {0, 0, -1};
        shocks_.push_back(shock);
      }
    }
  }

  BoxLattice box_{40, 20, 4};
  std::vector<ChordShock> shocks_;
};

bool keeps(const SignificantShocks& kept, std::uint32_t i, std::uint32_t j) {
  return std::any_of(kept.shocks.begin(), kept.shocks.end(),
                     [&](const ChordShock& s) { return s.place[0] == i && s.place[1] == j; });
}

Options with_significance(double significance) {
  Options options = quarter();
  options.significance = significance;
  return options;
}

TEST(SignificantShocks, APieceIsWeighedByAreaStrengthAndTurn) {
  const PrunedPlane plane = {
      {0, 10, 0, 10, 1}, {30, 5, 0, 4, 0.3, 0.5}  // 20 * 0.15 = 3 against 100
  };
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
  const PrunedPlane plane = {{0, 3, 0, 3, 1}, {20, 10, 0, 20, 0.24}};
  const SignificantShocks kept = plane.prune(with_significance(0));
  EXPECT_EQ(kept.shocks.size(), 9U);
  EXPECT_EQ(kept.pieces, std::vector<double>{1.0});
}

TEST(SignificantShocks, DiagonalNeighboursTouch) {
  const PrunedPlane plane = {{0, 5, 0, 5, 1}, {5, 5, 5, 5, 1}, {20, 1, 5, 1, 1}};
  EXPECT_EQ(plane.prune(with_significance(0)).pieces.size(), 2U);
}

// Between two pieces a weak field with a cheaper lane in row 3.
TEST(SignificantShocks, PiecesAreJoinedByTheCheapestWay) {
  const PrunedPlane plane = {
      {0, 5, 0, 8, 1}, {15, 5, 0, 8, 0.5}, {5, 10, 0, 3, 0.05}, {5, 10, 3, 1, 0.1}, {5, 10, 4, 4, 0.05}};
  const SignificantShocks kept = plane.prune();
  EXPECT_EQ(kept.pieces.size(), 2U);  // 10 steps of cost 10: too far to be weighed as one
  EXPECT_EQ(kept.bridges, 1U);
  // Cells reach half a step beyond the pieces, so that a way need not step on every shock of the lane.
  for (std::uint32_t i = 6; i < 14; ++i) EXPECT_TRUE(keeps(kept, i, 3)) << i;
  EXPECT_FALSE(keeps(kept, 10, 6));
  EXPECT_LE(kept.shocks.size(), 90U);
  Options options = quarter();
  options.near_cost = 101;
  EXPECT_EQ(plane.prune(options).pieces, std::vector<double>{1.0});
}

// A speck counts with the piece that it hangs on by a cheap way, but not with one far away.
TEST(SignificantShocks, NearPiecesAreWeighedAsOne) {
  const PrunedPlane plane = {{0, 10, 0, 20, 1},
                             {12, 1, 10, 1, 0.25},
                             {10, 2, 10, 1, 0.2},
                             {30, 1, 10, 1, 0.25},
                             {13, 17, 10, 1, 0.01}};
  const SignificantShocks kept = plane.prune();
  EXPECT_TRUE(keeps(kept, 12, 10));
  EXPECT_TRUE(keeps(kept, 11, 10));
  EXPECT_FALSE(keeps(kept, 30, 10));
  EXPECT_FALSE(keeps(kept, 20, 10));
  EXPECT_EQ(kept.pieces.size(), 1U);
}

// The volume is 40 * 20 * 4 = 3200, two thousandths of it 6.4.
TEST(SignificantShocks, WhereLittleIsCutOffNoShockIsStrong) {
  const PrunedPlane plane = {{0, 10, 0, 10, 1, 1, 6.5}, {20, 10, 0, 10, 1, 1, 6.3}};
  EXPECT_EQ(plane.prune().shocks.size(), 100U);
  Options options = quarter();
  options.min_erosion = 0;
  EXPECT_EQ(plane.prune(options).shocks.size(), 200U);
}

// Several boxes in one job, each with shocks laid by hand.
class Boxes {
 public:
  explicit Boxes(const Mesh& mesh) : solid_(make_solid(mesh)) {
    LatticeOptions options;
    options.spacing = 1;
    lattice_ = make_lattice(solid_, options);
    std::vector<std::uint32_t> all(lattice_.points);
    for (std::uint32_t p = 0; p < all.size(); ++p) all[p] = p;
    places_ = lattice_places(lattice_, all);
  }

  // A square of n x n shocks along axis 0 from a place on.
  void add(const LatticePlace& from, std::uint32_t n, double turn, double erosion) {
    for (std::uint32_t j = 0; j < n; ++j) {
      for (std::uint32_t k = 0; k < n; ++k) {
        ChordShock shock;
        shock.place = {from[0], from[1] + j, from[2] + k};
        const auto at = std::lower_bound(places_.begin(), places_.end(), shock.place);
        shock.point = static_cast<std::uint32_t>(at - places_.begin());
        shock.erosion = erosion;
        shock.strength = 1;
        shock.turn = turn;
        shock.gradient_low = {1, 0, 0};
        shock.gradient_high = {-1, 0, 0};
        shocks_.push_back(shock);
      }
    }
  }

  SignificantShocks prune() {
    std::sort(shocks_.begin(), shocks_.end(),
              [](const ChordShock& a, const ChordShock& b) { return a.point < b.point; });
    return significant_shocks(lattice_, SolidParts(solid_, lattice_), shocks_, quarter().significance,
                              quarter());
  }

 private:
  Solid solid_;
  Lattice lattice_;
  std::vector<LatticePlace> places_;
  std::vector<ChordShock> shocks_;
};

// Boxes of 4 x 16 x 16 points, a quarter of a step apart: cells reach over the gap.
constexpr double kThick = 15.75;

void add_sheet_and_specks(Boxes& boxes, std::uint32_t k) {
  boxes.add({1, 0, k}, 12, 1, 100);
  boxes.add({1, 12, k + 4}, 4, 0.1, 100);    // weak, up to the rim of the box below
  boxes.add({1, 15, k + 15}, 1, 0.26, 100);  // a strong one that weighs little
  boxes.add({1, 14, k + 13}, 1, 1, 0.5);     // where less than 1.024 is cut off
}

TEST(SignificantShocks, CopiesOfASolidKeepWhatOneKeeps) {
  Boxes one(make_box(4, 16, kThick));
  add_sheet_and_specks(one, 0);
  const SignificantShocks alone = one.prune();
  ASSERT_EQ(alone.pieces.size(), 1U);
  ASSERT_LT(alone.shocks.size(), 12U * 12U + 17U);
  Mesh mesh;
  for (std::uint32_t copy = 0; copy < 3; ++copy) {
    mesh = joined(mesh, moved(make_box(4, 16, kThick), {0, 0, 16.0 * copy}));
  }
  Boxes three(mesh);
  for (std::uint32_t copy = 0; copy < 3; ++copy) add_sheet_and_specks(three, 16 * copy);
  const SignificantShocks kept = three.prune();
  EXPECT_EQ(kept.pieces, std::vector<double>(3, alone.pieces[0]));
  EXPECT_EQ(kept.bridges, 3 * alone.bridges);
  ASSERT_EQ(kept.shocks.size(), 3 * alone.shocks.size());
  for (std::uint32_t copy = 0; copy < 3; ++copy) {
    for (const ChordShock& shock : alone.shocks) {
      const LatticePlace place{shock.place[0], shock.place[1], shock.place[2] + 16 * copy};
      EXPECT_TRUE(std::any_of(kept.shocks.begin(), kept.shocks.end(),
                              [&](const ChordShock& s) { return s.place == place; }));
    }
  }
}

// 1 of 145 parts of the weight, and E = 0.5 of 32 beside 12800.
TEST(SignificantShocks, ASmallSolidIsWeighedAlone) {
  Boxes boxes(joined(make_box(20, 20, 32), moved(make_box(4, 4, 2), {30, 0, 0})));
  boxes.add({10, 2, 2}, 12, 1, 100);
  boxes.add({31, 1, 0}, 1, 1, 0.5);
  const SignificantShocks kept = boxes.prune();
  EXPECT_EQ(kept.shocks.size(), 145U);
  EXPECT_EQ(kept.pieces, (std::vector<double>{1, 1}));
}

TEST(SignificantShocks, TellsWhatThereWasToChooseFrom) {
  const PrunedPlane plane = {
      {0, 10, 0, 10, 0.9}, {20, 5, 0, 5, 0.9}, {20, 5, 10, 5, 0.2}, {30, 3, 0, 2, 0.3, 1, 3.1}};
  const SignificantShocks kept = plane.prune(with_significance(0.9));
  EXPECT_TRUE(kept.shocks.empty());
  EXPECT_EQ(kept.census.candidates, 156U);
  EXPECT_EQ(kept.census.wide, 131U);
  EXPECT_EQ(kept.census.strong, 125U);
  EXPECT_EQ(kept.census.max_turn, 0.9);
  EXPECT_NEAR(kept.census.max_piece_share, 0.8, 1e-12);
}

TEST(SignificantShocks, NothingComesOfNothing) {
  const PrunedPlane plane = {};
  EXPECT_TRUE(plane.prune().shocks.empty());
  EXPECT_TRUE(plane.prune().pieces.empty());
}

TEST(SignificantShocks, RefuseASignificanceOutOfRange) {
  for (const double significance : {-1.0, 1.5, std::nan("")})
    EXPECT_THROW(PrunedPlane({}).prune(with_significance(significance)), CoreError);
}

}  // namespace
}  // namespace affskel::core

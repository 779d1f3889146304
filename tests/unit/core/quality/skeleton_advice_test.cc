#include "core/quality/skeleton_advice.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/normal_block.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

constexpr double kStrongTurn = ChordConstants().strong_turn;

Advice advice_for(const std::vector<double>& divergence, const OptimalDirections& optimal,
                  const Lattice& lattice, double threshold = 7) {
  return empty_skeleton_advice(lattice, optimal, divergence, ShockOperator::kZuckerHummel, threshold);
}

bool says(const Advice& advice, const std::string& part) {
  return advice.text.find(part) != std::string::npos;
}

bool suggests(const Advice& advice, const std::string& name, const std::string& value) {
  return std::any_of(advice.settings.begin(), advice.settings.end(),
                     [&](const Setting& setting) { return setting.name == name && setting.value == value; });
}

// What any program may show names no option of one of them.
testing::AssertionResult is_plain(const Advice& advice) {
  if (advice.text.find("--") == std::string::npos) return testing::AssertionSuccess();
  return testing::AssertionFailure() << advice.text;
}

// 1000 points, hence a sheet of 100: |H| = 0.001 (p + 1) keeps 100 points above 0.9, and 0.99 * 0.901 = 0.892
// leaves 108 of them.
TEST(EmptySkeletonAdvice, NamesTheLargestHAndAThresholdThatKeepsASheet) {
  NormalBlock block({10, 10, 10});
  std::vector<double> divergence;
  OptimalDirections optimal;
  for (std::uint32_t p = 0; p < 1000; ++p) {
    divergence.push_back((p % 2 == 0 ? 0.001 : -0.001) * (p + 1));
    optimal.push_back(p);
  }
  const Advice advice = advice_for(divergence, optimal, block.lattice);
  EXPECT_TRUE(says(advice, "above the threshold 7; the largest is 1.")) << advice.text;
  EXPECT_TRUE(says(advice, "A threshold of 0.892 would keep 108 of the 1000 points")) << advice.text;
  EXPECT_TRUE(suggests(advice, "threshold", "0.892"));
  EXPECT_TRUE(is_plain(advice));
  EXPECT_FALSE(says(advice, "directions")) << advice.text;
  EXPECT_FALSE(says(advice, "spacing")) << advice.text;
}

TEST(EmptySkeletonAdvice, SuggestsDirectionsWhenFewAreOptimal) {
  NormalBlock block({10, 10, 10});
  OptimalDirections optimal(1000, 3);
  for (std::size_t p = 0; p < 500; ++p) optimal[p] = 8;
  const Advice advice = advice_for(std::vector<double>(1000, 1), optimal, block.lattice);
  EXPECT_TRUE(says(advice, "Only 2 directions")) << advice.text;
  EXPECT_TRUE(suggests(advice, "directions", "triangles+sphere:1000"));
  EXPECT_TRUE(says(advice, "A threshold of 0.99 would keep 1000 of the 1000")) << advice.text;
  EXPECT_TRUE(suggests(advice, "threshold", "0.99"));
  EXPECT_TRUE(is_plain(advice));
}

TEST(EmptySkeletonAdvice, SuggestsASmallerSpacingWhenPointsAreFew) {
  NormalBlock block({3, 3, 3}, 0.25);
  OptimalDirections optimal(27);
  const Advice advice = advice_for(std::vector<double>(27, 0), optimal, block.lattice);
  EXPECT_TRUE(says(advice, "the optimal normals do not change anywhere")) << advice.text;
  EXPECT_TRUE(says(advice, "only 27 sample points")) << advice.text;
  EXPECT_TRUE(says(advice, "smaller spacing than 0.25")) << advice.text;
  EXPECT_FALSE(says(advice, "would keep")) << advice.text;
}

TEST(EmptySkeletonAdvice, SuggestsNoDirectionsThatTheJobHas) {
  NormalBlock block({10, 10, 10});
  const std::vector<double> ones(1000, 1);
  const OptimalDirections few(1000, 3);
  const Advice advice =
      empty_skeleton_advice(block.lattice, few, ones, ShockOperator::kZuckerHummel, 7, 1000);
  EXPECT_TRUE(says(advice, "Only 1 direction is")) << advice.text;
  EXPECT_FALSE(says(advice, "submit with more")) << advice.text;
  EXPECT_FALSE(suggests(advice, "directions", "triangles+sphere:1000"));
  const Advice sheet = empty_sheet_advice(block.lattice, {7, 0, 0, 0.0625, 0}, 0.005, kStrongTurn, 2000);
  EXPECT_TRUE(says(sheet, "submit with a smaller spacing")) << sheet.text;
  EXPECT_TRUE(sheet.settings.empty());
  EXPECT_TRUE(empty_sheet_advice(block.lattice, {}, 0.005, kStrongTurn, 2000).settings.empty());
  EXPECT_FALSE(empty_sheet_advice(block.lattice, {}, 0.005, kStrongTurn, 1999).settings.empty());
}

// Only one point has any H: the suggestion must keep at least that one.
TEST(EmptySkeletonAdvice, SuggestsAThresholdThatKeepsSomethingWheneverThereIsSomething) {
  NormalBlock block({10, 10, 10});
  std::vector<double> divergence(1000, 0);
  divergence[77] = -3;
  const Advice advice = advice_for(divergence, OptimalDirections(1000, 0), block.lattice);
  EXPECT_TRUE(says(advice, "A threshold of 2.97 would keep 1 of the 1000 points")) << advice.text;
  EXPECT_TRUE(suggests(advice, "threshold", "2.97"));
  EXPECT_TRUE(is_plain(advice));
}

TEST(EmptySheetAdvice, NamesAThresholdThatKeepsTheHeaviestPiece) {
  NormalBlock block({10, 10, 10});
  const Advice advice = empty_sheet_advice(block.lattice, {156, 131, 125, 0.9, 0.8}, 0.9, kStrongTurn);
  EXPECT_TRUE(says(advice, "all 125 strong shocks")) << advice.text;
  EXPECT_TRUE(says(advice, "below the significance 0.9; the heaviest weighs 0.8")) << advice.text;
  EXPECT_TRUE(says(advice, "A threshold of 0.792 would keep it")) << advice.text;
  EXPECT_TRUE(suggests(advice, "threshold", "0.792"));
  EXPECT_TRUE(is_plain(advice));
  EXPECT_FALSE(says(advice, "spacing")) << advice.text;
}

// Turns of 1/16 and 1/2 are angles of 29 and 90 degrees.
TEST(EmptySheetAdvice, NamesTheWidestAngleThereIs) {
  NormalBlock block({10, 10, 10});
  const Advice advice = empty_sheet_advice(block.lattice, {7, 0, 0, 0.0625, 0}, 0.005, kStrongTurn);
  EXPECT_TRUE(says(advice, "differ by 29 degrees at most, and a skeleton needs 84")) << advice.text;
  EXPECT_FALSE(suggests(advice, "frame", "axis"));
  EXPECT_TRUE(suggests(advice, "directions", "triangles+sphere:2000"));
  EXPECT_TRUE(is_plain(advice));
  EXPECT_FALSE(says(advice, "would keep")) << advice.text;
}

TEST(EmptySheetAdvice, SuggestsOtherAxesWhenTheseAreStretched) {
  NormalBlock block({10, 10, 10});
  Lattice lattice = block.lattice;
  lattice.grid.axes = {Vec3{0, 0.1, 0}, Vec3{-0.1, 0, 0}, Vec3{0, 0, 0.1}};
  EXPECT_FALSE(
      suggests(empty_sheet_advice(lattice, {7, 0, 0, 0.0625, 0}, 0.005, kStrongTurn), "frame", "axis"));
  lattice.grid.axes = {Vec3{0.2, 0, 0}, Vec3{0, 0.1, 0}, Vec3{0, 0, 0.05}};
  const Advice stretched = empty_sheet_advice(lattice, {7, 0, 0, 0.0625, 0}, 0.005, kStrongTurn);
  EXPECT_TRUE(says(stretched, "the frame axis or pca"));
  EXPECT_TRUE(suggests(stretched, "frame", "axis"));
  EXPECT_TRUE(is_plain(stretched));
}

TEST(EmptySheetAdvice, TellsShocksNearTheSurfaceFromNone) {
  NormalBlock block({3, 3, 3}, 0.25);
  const Advice near = empty_sheet_advice(block.lattice, {9, 5, 0, 0.7, 0}, 0.005, kStrongTurn);
  EXPECT_TRUE(says(near, "at none of the 5")) << near.text;
  EXPECT_TRUE(says(near, "only 27 sample points: submit with a smaller spacing than 0.25")) << near.text;
  const Advice none = empty_sheet_advice(block.lattice, {}, 0.005, kStrongTurn);
  EXPECT_TRUE(says(none, "nowhere do two different chords")) << none.text;
}

TEST(LowBarriersAdvice, NamesOneThatKeepsATriangle) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 2, 3}};
  const std::vector<double> barrier = {0.01, 0.5, 0.04, 0.02};
  const Advice advice = low_barriers_advice(triangles, {}, barrier, 0.1);
  EXPECT_TRUE(says(advice, "the greatest is 0.02. A least barrier of 0.0198 would keep one")) << advice.text;
  EXPECT_TRUE(suggests(advice, "min_barrier", "0.0198"));
  EXPECT_TRUE(is_plain(advice));
  EXPECT_TRUE(says(low_barriers_advice(triangles, {}, std::vector<double>(4, 0.0), 0.1), "only turn fast"));
  const Advice curves = low_barriers_advice({}, std::vector<Segment>{{0, 1}, {1, 2}}, barrier, 0.1);
  EXPECT_TRUE(says(curves, "no segment of the curves")) << curves.text;
}

TEST(CoarseLatticeAdvice, NamesWhatDiffersAndMorePoints) {
  NormalBlock block({10, 10, 10}, 0.5);
  EXPECT_TRUE(coarse_lattice_advice(block.lattice, {1, 2, 1}, {1, 2, 1}).text.empty());
  const Advice advice = coarse_lattice_advice(block.lattice, {1, 3, 0}, {2, 1, 1});
  EXPECT_TRUE(says(advice, "1 piece, 3 tunnels and 0 voids")) << advice.text;
  EXPECT_TRUE(says(advice, "2 pieces, 1 tunnel and 1 void")) << advice.text;
  EXPECT_TRUE(says(advice, "Submit with a smaller spacing than 0.5.")) << advice.text;
  EXPECT_TRUE(suggests(advice, "points", "10000"));
  EXPECT_TRUE(is_plain(advice));
}

TEST(CoarseLatticeAdvice, AdvisesNoPointsWhereSurfacesCross) {
  NormalBlock block({10, 10, 10}, 0.5);
  const Advice advice = coarse_lattice_advice(block.lattice, {1, 0, 0}, {2, 0, 0}, true);
  EXPECT_TRUE(says(advice, "cross or touch each other, and are counted each by itself")) << advice.text;
  EXPECT_FALSE(says(advice, "spacing")) << advice.text;
  EXPECT_TRUE(advice.settings.empty());
  EXPECT_TRUE(coarse_lattice_advice(block.lattice, {1, 0, 0}, {1, 0, 0}, true).text.empty());
}

TEST(SmallSkeletonAdvice, IsForSolidsOfTwoPointsAcross) {
  NormalBlock block({10, 10, 3}, 0.5);
  const Advice advice = small_skeleton_advice(block.lattice, std::vector<float>{0.5f, 0.5f}, 1000);
  EXPECT_TRUE(says(advice, "at most two across the solid")) << advice.text;
  EXPECT_TRUE(suggests(advice, "points", "10000"));
  EXPECT_TRUE(is_plain(advice));
  EXPECT_TRUE(small_skeleton_advice(block.lattice, std::vector<float>{0.5f, 1.5f, 0.5f}, 1000).text.empty());
}

TEST(SmallSkeletonAdvice, AsksForPointsOnlyWhereTheyAreFewAcross) {
  NormalBlock block({20, 20, 20}, 0.5);
  const Advice few = small_skeleton_advice(block.lattice, std::vector<float>{0.5f, 1.25f}, 4);
  EXPECT_TRUE(says(few, "hardly more than a point")) << few.text;
  EXPECT_TRUE(says(few, "2.5 across the solid")) << few.text;
  EXPECT_TRUE(suggests(few, "points", "70000"));
  EXPECT_TRUE(is_plain(few));
  const Advice enough = small_skeleton_advice(block.lattice, std::vector<float>{0.5f, 3.5f}, 5);
  EXPECT_TRUE(says(enough, "hardly show more")) << enough.text;
  EXPECT_TRUE(enough.settings.empty());
  EXPECT_TRUE(small_skeleton_advice(block.lattice, std::vector<float>{0.5f, 3.5f}, 6).text.empty());
}

// A rod with a skeleton in one of its ends alone, and one all along.
TEST(BareSolidAdvice, IsForSolidsFarFromTheirSkeleton) {
  NormalBlock block({3, 3, 60}, 0.5);
  const std::vector<float> radius(block.lattice.points, 1.5f);
  std::vector<Vec3> places;
  std::vector<std::uint32_t> points;
  for (double k = 0; k < 60; k += 5) {
    places.push_back(0.5 * Vec3{1, 1, k});
    points.push_back(0);
  }
  EXPECT_TRUE(bare_solid_advice(block.lattice, radius, places, points).text.empty());
  places.resize(1);  // farther than 9 spacings: all but 9 layers of 60, and of the tenth the middle
  const Advice advice = bare_solid_advice(block.lattice, radius, places, points);
  EXPECT_TRUE(says(advice, "85 % of the solid")) << advice.text;
  EXPECT_TRUE(says(advice, "it may be weaker there, or none")) << "as in a table's flat top";
  EXPECT_TRUE(is_plain(advice));
  EXPECT_TRUE(bare_solid_advice(block.lattice, radius, {}, {}).text.empty());
}

// A plate with a line across its middle, and one with lines everywhere.
TEST(FlatSolidAdvice, IsForSolidsThatLinesLeaveOut) {
  NormalBlock plate({60, 60, 3}, 0.5);
  const std::vector<float> radius(plate.lattice.points, 1.5f);
  std::vector<Vec3> places;
  for (double i = 0; i < 60; ++i) places.push_back(0.5 * Vec3{i, 30, 1});
  std::vector<std::uint32_t> points(places.size(), 0);
  const Advice advice = flat_solid_advice(plate.lattice, radius, places, points);
  EXPECT_TRUE(says(advice, "71 % of the solid"))
      << advice.text;  // but for 19 rows of 60 in the middle layer, 17 in others
  EXPECT_TRUE(says(advice, "The operator ridge has their sheets"));
  EXPECT_TRUE(is_plain(advice));
  for (double i = 0; i < 60; ++i) {
    places.push_back(0.5 * Vec3{i, 12, 1});
    places.push_back(0.5 * Vec3{i, 48, 1});
  }
  points.resize(places.size(), 0);
  EXPECT_TRUE(flat_solid_advice(plate.lattice, radius, places, points).text.empty());
}

TEST(LittleRidgeAdvice, SuggestsALowerThreshold) {
  EXPECT_TRUE(little_ridge_advice(0.5, 6, 9).text.empty());
  const Advice none = little_ridge_advice(0, 6, 9);
  EXPECT_TRUE(says(none, "none of it lies on a ridge")) << none.text;
  EXPECT_TRUE(suggests(none, "threshold", "2"));
  EXPECT_TRUE(is_plain(none));
  EXPECT_TRUE(says(little_ridge_advice(0.003, 6, 9), "only 0.3 % of it"));
}

TEST(LittleRidgeAdvice, SuggestsNoneAboveWhatThereIs) {
  EXPECT_TRUE(suggests(little_ridge_advice(0, 6, 1.5), "threshold", "0.5"));
  const Advice none = little_ridge_advice(0, 6, 0);
  EXPECT_TRUE(none.settings.empty());
  EXPECT_TRUE(says(none, "None is an eighth as strong")) << none.text;
  EXPECT_TRUE(is_plain(none));
}

TEST(StretchedLimbsAdvice, IsForFramesThatStretch) {
  NormalBlock block({10, 10, 10});
  Lattice lattice = block.lattice;
  lattice.grid.axes = {Vec3{0, 0.1, 0}, Vec3{-0.1, 0, 0}, Vec3{0, 0, 0.14}};
  EXPECT_EQ(stretched_limbs_advice(lattice).text, "");
  lattice.grid.axes = {Vec3{0.2, 0, 0}, Vec3{0, 0.1, 0}, Vec3{0.05, 0.05, 0.05}};
  const Advice advice = stretched_limbs_advice(lattice);
  EXPECT_TRUE(says(advice, "stretched 4.9 times")) << advice.text;
  EXPECT_TRUE(suggests(advice, "frame", "axis"));
  EXPECT_TRUE(is_plain(advice));
}

// A rod with its sheet; a part of it; with too few points for one; in two pieces.
TEST(StraySheetAdvice, TellsWhatASheetLacks) {
  NormalBlock block({3, 3, 60}, 0.5);
  const std::vector<float> radius(block.lattice.points, 1.5f);
  const BettiNumbers one{1, 0, 0};
  std::vector<Vec3> places;
  for (double k = 0; k < 60; ++k) places.push_back(0.5 * Vec3{1, 1, k});
  const std::vector<std::uint32_t> points(places.size(), 0);
  const std::span<const Vec3> all = places;
  const auto advice = [&](std::span<const Vec3> of, const BettiNumbers& sheet) {
    return stray_sheet_advice(block.lattice, radius, of, points, sheet, one);
  };
  EXPECT_TRUE(advice(all, one).text.empty());
  EXPECT_TRUE(says(advice(all.first(10), one), "% of the solid are farther from it"));
  const Advice torn = advice(all, {2, 1, 0});
  EXPECT_TRUE(says(torn, "it has 2 pieces, 1 tunnel and 0 voids, the solid 1 piece, 0 tunnels and 0 voids"));
  EXPECT_TRUE(is_plain(torn));
  const std::vector<Vec3> few = {places[10], places[30], places[50]};
  EXPECT_TRUE(says(advice(few, one), "it has only 3 points, a sheet through the whole solid about 67"));
  EXPECT_TRUE(advice({}, {}).text.empty()) << "what is empty has other advice";
}

}  // namespace
}  // namespace affskel::core

#include "core/quality/skeleton_advice.h"

#include <gtest/gtest.h>

#include "core/normal_block.h"

namespace affskel::core {
namespace {

constexpr double kStrongTurn = ChordConstants().strong_turn;

std::string advice_for(const std::vector<double>& divergence, const OptimalDirections& optimal,
                       const Lattice& lattice, double threshold = 7) {
  return empty_skeleton_advice(lattice, optimal, divergence, ShockOperator::kZuckerHummel, threshold);
}

bool says(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
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
  const std::string advice = advice_for(divergence, optimal, block.lattice);
  EXPECT_TRUE(says(advice, "above the threshold 7; the largest is 1.")) << advice;
  EXPECT_TRUE(says(advice, "--threshold 0.892 would keep 108 of the 1000 points")) << advice;
  EXPECT_FALSE(says(advice, "directions")) << advice;
  EXPECT_FALSE(says(advice, "spacing")) << advice;
}

TEST(EmptySkeletonAdvice, SuggestsDirectionsWhenFewAreOptimal) {
  NormalBlock block({10, 10, 10});
  OptimalDirections optimal(1000, 3);
  for (std::size_t p = 0; p < 500; ++p) optimal[p] = 8;
  const std::string advice = advice_for(std::vector<double>(1000, 1), optimal, block.lattice);
  EXPECT_TRUE(says(advice, "Only 2 directions")) << advice;
  EXPECT_TRUE(says(advice, "--directions triangles+sphere:1000")) << advice;
  EXPECT_TRUE(says(advice, "--threshold 0.99 would keep 1000 of the 1000")) << advice;
}

TEST(EmptySkeletonAdvice, SuggestsASmallerSpacingWhenPointsAreFew) {
  NormalBlock block({3, 3, 3}, 0.25);
  OptimalDirections optimal(27);
  const std::string advice = advice_for(std::vector<double>(27, 0), optimal, block.lattice);
  EXPECT_TRUE(says(advice, "the optimal normals do not change anywhere")) << advice;
  EXPECT_TRUE(says(advice, "only 27 sample points")) << advice;
  EXPECT_TRUE(says(advice, "smaller spacing than 0.25")) << advice;
  EXPECT_FALSE(says(advice, "--threshold")) << advice;
}

// Only one point has any H: the suggestion must keep at least that one.
TEST(EmptySkeletonAdvice, SuggestsAThresholdThatKeepsSomethingWheneverThereIsSomething) {
  NormalBlock block({10, 10, 10});
  std::vector<double> divergence(1000, 0);
  divergence[77] = -3;
  const std::string advice = advice_for(divergence, OptimalDirections(1000, 0), block.lattice);
  EXPECT_TRUE(says(advice, "--threshold 2.97 would keep 1 of the 1000 points")) << advice;
}

TEST(EmptySheetAdvice, NamesAThresholdThatKeepsTheHeaviestPiece) {
  NormalBlock block({10, 10, 10});
  const std::string advice = empty_sheet_advice(block.lattice, {156, 131, 125, 0.9, 0.8}, 0.9, kStrongTurn);
  EXPECT_TRUE(says(advice, "all 125 strong shocks")) << advice;
  EXPECT_TRUE(says(advice, "below the significance 0.9; the heaviest weighs 0.8")) << advice;
  EXPECT_TRUE(says(advice, "--threshold 0.792 would keep it")) << advice;
  EXPECT_FALSE(says(advice, "spacing")) << advice;
}

// Turns of 1/16 and 1/2 are angles of 29 and 90 degrees.
TEST(EmptySheetAdvice, NamesTheWidestAngleThereIs) {
  NormalBlock block({10, 10, 10});
  const std::string advice = empty_sheet_advice(block.lattice, {7, 0, 0, 0.0625, 0}, 0.005, kStrongTurn);
  EXPECT_TRUE(says(advice, "differ by 29 degrees at most, and a skeleton needs 89")) << advice;
  EXPECT_FALSE(says(advice, "--frame")) << advice;
  EXPECT_FALSE(says(advice, "--threshold")) << advice;
}

TEST(EmptySheetAdvice, SuggestsOtherAxesWhenTheseAreStretched) {
  NormalBlock block({10, 10, 10});
  Lattice lattice = block.lattice;
  lattice.grid.axes = {Vec3{0, 0.1, 0}, Vec3{-0.1, 0, 0}, Vec3{0, 0, 0.1}};
  EXPECT_FALSE(says(empty_sheet_advice(lattice, {7, 0, 0, 0.0625, 0}, 0.005, kStrongTurn), "--frame"));
  lattice.grid.axes = {Vec3{0.2, 0, 0}, Vec3{0, 0.1, 0}, Vec3{0, 0, 0.05}};
  EXPECT_TRUE(says(empty_sheet_advice(lattice, {7, 0, 0, 0.0625, 0}, 0.005, kStrongTurn),
                   "--frame axis or --frame pca"));
}

TEST(EmptySheetAdvice, TellsShocksNearTheSurfaceFromNone) {
  NormalBlock block({3, 3, 3}, 0.25);
  const std::string near = empty_sheet_advice(block.lattice, {9, 5, 0, 0.7, 0}, 0.005, kStrongTurn);
  EXPECT_TRUE(says(near, "at none of the 5")) << near;
  EXPECT_TRUE(says(near, "only 27 sample points: submit with a smaller spacing than 0.25")) << near;
  const std::string none = empty_sheet_advice(block.lattice, {}, 0.005, kStrongTurn);
  EXPECT_TRUE(says(none, "nowhere do two different chords")) << none;
}

TEST(EmptyRidgeAdvice, NamesAThresholdThatKeepsAPiece) {
  NormalBlock block({10, 10, 10});
  RidgePieces pieces;
  pieces.max_strength = 12;
  const std::string advice = empty_ridge_advice(block.lattice, pieces, {20, 24});
  EXPECT_TRUE(says(advice, "greatest strength is 12, less than the 24")) << advice;
  EXPECT_TRUE(says(advice, "--threshold 9.9 would keep one")) << advice;
  EXPECT_TRUE(says(empty_ridge_advice(block.lattice, {}, {}), "nowhere do the normals turn fast"));
}

TEST(LowBarriersAdvice, NamesOneThatKeepsATriangle) {
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 2, 3}};
  const std::vector<double> barrier = {0.01, 0.5, 0.04, 0.02};
  const std::string advice = low_barriers_advice(triangles, {}, barrier, 0.1);
  EXPECT_NE(advice.find("the greatest is 0.02. --min-barrier 0.0198"), std::string::npos) << advice;
  EXPECT_NE(low_barriers_advice(triangles, {}, std::vector<double>(4, 0.0), 0.1).find("only turn fast"),
            std::string::npos);
  const std::string curves = low_barriers_advice({}, std::vector<Segment>{{0, 1}, {1, 2}}, barrier, 0.1);
  EXPECT_TRUE(says(curves, "no segment of the curves")) << curves;
}

}  // namespace
}  // namespace affskel::core

#include "core/skeleton_advice.h"

#include <gtest/gtest.h>

#include "core/normal_block.h"

namespace affskel::core {
namespace {

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

}  // namespace
}  // namespace affskel::core

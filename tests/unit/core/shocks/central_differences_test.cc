#include "core/shocks/central_differences.h"

#include <gtest/gtest.h>

#include "core/normal_block.h"
#include "core/shocks/shock_operator.h"

namespace affskel::core {
namespace {

using Indices = NormalBlock::Indices;

TEST(CentralDifferences, GiveTheDerivativeOfALinearField) {
  NormalBlock block({5, 5, 5}, 0.5);
  block.fill([](const Indices& p) { return Vec3{p[0] / 8.0, 0.5 * p[1] / 8.0, -2.0 * p[2] / 8.0}; });
  const std::vector<double> h =
      divergence(ShockOperator::kCentral, block.lattice, block.normals, block.optimal);
  EXPECT_NEAR(h[block.at({2, 2, 2})], (1 + 0.5 - 2) / 8 / 0.5, 1e-14);
  // One neighbour of a point at the surface is the point itself: half the difference.
  EXPECT_NEAR(h[block.at({4, 2, 2})], (0.5 + 0.5 - 2) / 8 / 0.5, 1e-14);
  EXPECT_NEAR(h[block.at({0, 2, 2})], (0.5 + 0.5 - 2) / 8 / 0.5, 1e-14);
}

TEST(CentralDifferences, GiveHalfTheJumpOnBothSidesOfASheet) {
  NormalBlock block({5, 5, 6}, 0.25);
  block.fill([](const Indices& p) { return jumping_normal(p, 1, 2, 1.5); });
  const std::vector<double> h =
      divergence(ShockOperator::kCentral, block.lattice, block.normals, block.optimal);
  for (std::uint32_t j = 0; j < 5; ++j) {
    EXPECT_NEAR(h[block.at({0, j, 5})], j == 2 || j == 3 ? -1.5 / 0.5 : 0, 1e-13);
  }
}

// The reason for alpha = 0.57: at alpha = 1 even opposite normals would give nothing.
TEST(CentralDifferences, ThresholdIsWithinReach) {
  const double largest = 2 / (2 * 0.25);
  EXPECT_LT(central_difference_threshold(0.25), largest);
  EXPECT_EQ(1 / 0.25, largest);
}

}  // namespace
}  // namespace affskel::core

#include "core/shocks/intermediate_differences.h"

#include <gtest/gtest.h>

#include "core/erosion/field.h"
#include "core/normal_block.h"
#include "core/shocks/shock_operator.h"

namespace affskel::core {
namespace {

using Indices = NormalBlock::Indices;

TEST(IntermediateDifferences, GiveTheDerivativeOfALinearField) {
  NormalBlock block({5, 5, 5}, 0.5);
  block.fill([](const Indices& p) { return Vec3{p[0] / 8.0, 0.5 * p[1] / 8.0, -2.0 * p[2] / 8.0}; });
  const std::vector<double> h =
      divergence(ShockOperator::kIntermediate, block.lattice, block.normals, block.optimal);
  EXPECT_NEAR(h[block.at({2, 2, 2})], (1 + 0.5 - 2) / 8 / 0.5, 1e-14);
  // The last point of a line has no next one.
  EXPECT_NEAR(h[block.at({4, 2, 2})], (0.5 - 2) / 8 / 0.5, 1e-14);
  EXPECT_NEAR(h[block.at({4, 4, 4})], 0, 1e-14);
}

TEST(IntermediateDifferences, GiveTheJumpOnTheLowerSideOfASheet) {
  NormalBlock block({5, 5, 6}, 0.25);
  block.fill([](const Indices& p) { return jumping_normal(p, 2, 2, 1.5); });
  const std::vector<double> h =
      divergence(ShockOperator::kIntermediate, block.lattice, block.normals, block.optimal);
  for (std::uint32_t k = 0; k < 6; ++k) EXPECT_NEAR(h[block.at({0, 2, k})], k == 2 ? -1.5 / 0.25 : 0, 1e-13);
}

TEST(IntermediateDifferences, TakeAPointWithoutDirectionAsZero) {
  NormalBlock block({3, 1, 1});
  block.fill([](const Indices&) { return Vec3{1, 0, 0}; });
  block.optimal[1] = FieldValue::kNoDirection;
  EXPECT_EQ(divergence(ShockOperator::kIntermediate, block.lattice, block.normals, block.optimal),
            (std::vector<double>{-1, 1, 0}));
}

}  // namespace
}  // namespace affskel::core

#include "core/shocks/sobel.h"

#include <gtest/gtest.h>

#include "core/normal_block.h"
#include "core/shocks/shock_operator.h"

namespace affskel::core {
namespace {

using Indices = NormalBlock::Indices;

// Each derivative is 2/8 times the weights of a plane: (1 + 2 + 1)^2.
TEST(Sobel, LinearNormalsGiveTheSumOfTheWeights) {
  NormalBlock block({5, 5, 5}, 0.5);
  block.fill([](const Indices& p) { return Vec3{p[0] / 8.0, 0.5 * p[1] / 8.0, -2.0 * p[2] / 8.0}; });
  EXPECT_NEAR(
      divergence(ShockOperator::kSobel, block.lattice, block.normals, block.optimal)[block.at({2, 2, 2})],
      (1 + 0.5 - 2) * 2 / 8 * 16, 1e-13);
}

// One neighbour alone shows its weight: a face counts 4, an edge 2 along each of two axes, a corner 1.
TEST(Sobel, WeighsNeighboursOneTwoOne) {
  const auto seen = [](const Indices& neighbour) {
    NormalBlock block({3, 3, 3});
    block.fill([&](const Indices& p) { return p == neighbour ? Vec3{1, 0.5, 0.25} : Vec3{}; });
    return divergence(ShockOperator::kSobel, block.lattice, block.normals,
                      block.optimal)[block.at({1, 1, 1})];
  };
  EXPECT_EQ(seen({2, 1, 1}), 4 * 1.0);
  EXPECT_EQ(seen({1, 0, 1}), -4 * 0.5);
  EXPECT_EQ(seen({2, 2, 1}), 2 * (1 + 0.5));
  EXPECT_EQ(seen({1, 0, 2}), 2 * (-0.5 + 0.25));
  EXPECT_EQ(seen({2, 2, 2}), 1 + 0.5 + 0.25);
  EXPECT_EQ(seen({0, 2, 0}), -1 + 0.5 - 0.25);
  EXPECT_EQ(seen({1, 1, 1}), 0);
}

TEST(Sobel, AJumpGivesSixteenTimesItself) {
  NormalBlock block({6, 5, 5}, 0.25);
  block.fill([](const Indices& p) { return jumping_normal(p, 0, 2, 1.5); });
  const std::vector<double> h =
      divergence(ShockOperator::kSobel, block.lattice, block.normals, block.optimal);
  for (std::uint32_t i = 0; i < 6; ++i) {
    EXPECT_NEAR(h[block.at({i, 2, 2})], i == 2 || i == 3 ? -1.5 * 16 : 0, 1e-13);
  }
}

}  // namespace
}  // namespace affskel::core

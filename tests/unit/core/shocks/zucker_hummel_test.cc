#include "core/shocks/zucker_hummel.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/erosion/field.h"
#include "core/normal_block.h"
#include "core/shocks/shock_operator.h"
#include "core/shocks/skeleton.h"

namespace affskel::core {
namespace {

struct Slab {
  Lattice lattice = NormalBlock({9, 9, 9}).lattice;
  // Index of a point of the 9 x 9 x 9 lattice.
  static std::uint32_t at(std::uint32_t i, std::uint32_t j, std::uint32_t k) { return (i * 9 + j) * 9 + k; }
};

const double kPlane = 1 + 4 * std::sqrt(0.5) + 4 * std::sqrt(1.0 / 3);

TEST(ZuckerHummel, ConstantNormalsHaveNoDivergence) {
  const Slab slab;
  for (double h :
       divergence(ShockOperator::kZuckerHummel, slab.lattice, {{0, 0.6, 0.8}}, OptimalDirections(729, 0)))
    EXPECT_EQ(h, 0);
}

// Normals (i, j, k) / 8 shifted: each derivative is 2/8 times the weights of a plane.
TEST(ZuckerHummel, LinearNormalsGiveTheSumOfTheWeights) {
  const Slab slab;
  DirectionSet normals;
  OptimalDirections optimal;
  for (std::uint32_t i = 0; i < 9; ++i) {
    for (std::uint32_t j = 0; j < 9; ++j) {
      for (std::uint32_t k = 0; k < 9; ++k) {
        optimal.push_back(static_cast<std::uint32_t>(normals.size()));
        normals.push_back({i / 8.0, 0.5 * j / 8.0, -2.0 * k / 8.0});
      }
    }
  }
  const std::vector<double> h = divergence(ShockOperator::kZuckerHummel, slab.lattice, normals, optimal);
  EXPECT_NEAR(h[Slab::at(4, 4, 4)], (1 + 0.5 - 2) * 2 / 8 * kPlane, 1e-12);
  EXPECT_NEAR(h[Slab::at(1, 7, 3)], (1 + 0.5 - 2) * 2 / 8 * kPlane, 1e-12);
}

// Upper half looks down, lower half up: the two layers at the jump get 2 * weights, the rest nothing.
TEST(ZuckerHummel, AJumpShowsOnBothSidesAndNowhereElse) {
  const Slab slab;
  OptimalDirections optimal(729);
  for (std::uint32_t i = 0; i < 9; ++i) {
    for (std::uint32_t j = 0; j < 9; ++j) {
      for (std::uint32_t k = 0; k < 9; ++k) optimal[Slab::at(i, j, k)] = k < 4 ? 0 : 1;
    }
  }
  const std::vector<double> h =
      divergence(ShockOperator::kZuckerHummel, slab.lattice, {{0, 0, 1}, {0, 0, -1}}, optimal);
  for (std::uint32_t k = 0; k < 9; ++k) {
    EXPECT_NEAR(h[Slab::at(4, 4, k)], k == 3 || k == 4 ? -2 * kPlane : 0, 1e-12);
  }
  // The corners of the two layers have too few neighbours to reach 7: 2 (1 + sqrt(2) + sqrt(3)/3) = 5.98.
  EXPECT_EQ(skeleton_points(h).size(), 2U * (81 - 4));
}

TEST(ZuckerHummel, ANeighbourOutsideCountsAsTheCentre) {
  const Slab slab;
  OptimalDirections optimal(729, 0);
  const std::uint32_t corner = Slab::at(0, 0, 0);
  optimal[corner] = 1;
  const std::vector<double> h =
      divergence(ShockOperator::kZuckerHummel, slab.lattice, {{1, 0, 0}, {0, 0, 0.5}}, optimal);
  // Along x the plane before the corner is all outside, hence (0, 0, 0.5); the one behind has 4 points
  // inside, which are (1, 0, 0): 1 face, 2 edges, 1 corner.  Along z: n_z = 0 there against 0.5.
  const double inside = 1 + 2 * std::sqrt(0.5) + std::sqrt(1.0 / 3);
  EXPECT_NEAR(h[corner], inside * (1 - 0) + inside * (0 - 0.5), 1e-12);
}

TEST(SkeletonPoints, KeepsLargeDivergenceOfEitherSign) {
  const std::vector<SkeletonPoint> kept = skeleton_points({0, 7.1, -7.1, 7, -7, 6.9});
  ASSERT_EQ(kept.size(), 2U);
  EXPECT_EQ(kept[0].point, 1U);
  EXPECT_EQ(kept[1].point, 2U);
  EXPECT_EQ(kept[1].divergence, -7.1);
  EXPECT_THROW(skeleton_points({1}, 0), CoreError);
  EXPECT_THROW(skeleton_points({1}, std::nan("")), CoreError);
}

}  // namespace
}  // namespace affskel::core

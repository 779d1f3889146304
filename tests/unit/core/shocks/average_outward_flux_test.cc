#include "core/shocks/average_outward_flux.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/normal_block.h"
#include "core/shocks/shock_operator.h"

namespace affskel::core {
namespace {

using Indices = NormalBlock::Indices;

// Normals that all point away from the centre leave through every point of the sphere: flux 1.
TEST(AverageOutwardFlux, IsOneAtAPerfectSource) {
  NormalBlock block({3, 3, 3});
  block.fill([](const Indices& p) {
    const Vec3 way{p[0] - 1.0, p[1] - 1.0, p[2] - 1.0};
    return norm(way) == 0 ? Vec3{} : (1 / norm(way)) * way;
  });
  EXPECT_NEAR(
      divergence(ShockOperator::kFlux, block.lattice, block.normals, block.optimal)[block.at({1, 1, 1})], 1,
      1e-14);
}

// n = c x: the mean of c |s| over 6 faces, 12 edges, 8 corners.
TEST(AverageOutwardFlux, LinearNormalsGiveTheMeanDistance) {
  NormalBlock block({3, 3, 3}, 0.5);
  block.fill([](const Indices& p) { return Vec3{0.1 * p[0], 0.1 * p[1], 0.1 * p[2]}; });
  EXPECT_NEAR(
      divergence(ShockOperator::kFlux, block.lattice, block.normals, block.optimal)[block.at({1, 1, 1})],
      0.1 * (6 + 12 * std::sqrt(2) + 8 * std::sqrt(3)) / 26, 1e-15);
}

TEST(AverageOutwardFlux, AJumpIsSeenByTheNineNeighboursBeyond) {
  NormalBlock block({5, 5, 6});
  block.fill([](const Indices& p) { return jumping_normal(p, 2, 2, 1.5); });
  const std::vector<double> h = divergence(ShockOperator::kFlux, block.lattice, block.normals, block.optimal);
  const double nine = 1 + 4 * std::sqrt(0.5) + 4 * std::sqrt(1. / 3);
  for (std::uint32_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(h[block.at({2, 2, k})], k == 2 || k == 3 ? -1.5 * nine / 26 : 0, 1e-14);
  }
}

// The identity that the threshold is taken from, the surface included.
TEST(AverageOutwardFlux, IsZuckerHummelOver26) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> component(-1, 1);
  NormalBlock block({4, 5, 6});
  block.fill([&](const Indices&) { return Vec3{component(random), component(random), component(random)}; });
  const std::vector<double> flux =
      divergence(ShockOperator::kFlux, block.lattice, block.normals, block.optimal);
  const std::vector<double> h =
      divergence(ShockOperator::kZuckerHummel, block.lattice, block.normals, block.optimal);
  for (std::size_t p = 0; p < h.size(); ++p) EXPECT_NEAR(26 * flux[p], h[p], 1e-13);
}

}  // namespace
}  // namespace affskel::core

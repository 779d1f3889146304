#include "core/shocks/shock_operator.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/normal_block.h"

namespace affskel::core {
namespace {

using Indices = NormalBlock::Indices;

std::vector<ShockOperator> all() {
  return {ShockOperator::kIntermediate, ShockOperator::kCentral, ShockOperator::kZuckerHummel,
          ShockOperator::kSobel, ShockOperator::kFlux};
}

TEST(ShockOperators, HaveNamesThatFindThem) {
  for (const ShockOperator one : all()) EXPECT_EQ(shock_operator_named(name_of(one)), one);
  EXPECT_EQ(shock_operator_named("chords"), std::nullopt);
  EXPECT_EQ(shock_operator_named(""), std::nullopt);
}

class EveryOperator : public testing::TestWithParam<ShockOperator> {
 protected:
  std::vector<double> of(const NormalBlock& block) const {
    return divergence(GetParam(), block.lattice, block.normals, block.optimal);
  }
};

INSTANTIATE_TEST_SUITE_P(All, EveryOperator, testing::ValuesIn(all()), [](const auto& param) {
  std::string name = name_of(param.param);
  std::erase(name, '-');
  return name;
});

TEST_P(EveryOperator, FindsNothingWhereNormalsAreEqual) {
  NormalBlock block({4, 5, 6}, 0.25);
  for (const double h : of(block.fill([](const Indices&) { return Vec3{0.48, 0.6, 0.64}; }))) EXPECT_EQ(h, 0);
}

TEST_P(EveryOperator, FindsNothingInAShear) {  // divergence-free: n = (y, z, x) / 8
  NormalBlock block({7, 7, 7});
  const std::vector<double> h = of(block.fill([](const Indices& p) {
    return Vec3{p[1] / 8.0, p[2] / 8.0, p[0] / 8.0};
  }));
  for (std::uint32_t i = 1; i < 6; ++i) EXPECT_NEAR(h[block.at({i, 3, 4})], 0, 1e-15);
}

TEST_P(EveryOperator, IsPositiveAtSourcesAndNegativeAtSinks) {
  for (const double sign : {1.0, -1.0}) {
    NormalBlock block({5, 5, 5});
    const std::vector<double> h = of(block.fill([&](const Indices& p) {
      const Vec3 way{p[0] - 2.0, p[1] - 2.0, p[2] - 2.0};
      const double length = norm(way);
      return length == 0 ? Vec3{} : (sign / length) * way;
    }));
    EXPECT_GT(sign * h[block.at({2, 2, 2})], 0.5);
  }
}

// The field turned by x -> y -> z -> x has the turned divergence.
TEST_P(EveryOperator, TreatsTheAxesAlike) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> component(-1, 1);
  NormalBlock block({4, 5, 6}), turned({6, 4, 5});
  block.fill([&](const Indices&) { return Vec3{component(random), component(random), component(random)}; });
  turned.fill([&](const Indices& p) {
    const Vec3& n = block.normals[block.at({p[1], p[2], p[0]})];
    return Vec3{n.z, n.x, n.y};
  });
  const std::vector<double> h = of(block), turned_h = of(turned);
  for (std::uint32_t i = 0; i < 4; ++i) {
    for (std::uint32_t j = 0; j < 5; ++j) {
      for (std::uint32_t k = 0; k < 6; ++k) {
        EXPECT_NEAR(h[block.at({i, j, k})], turned_h[turned.at({k, i, j})], 1e-13);
      }
    }
  }
}

TEST_P(EveryOperator, ShowsAJumpOnlyBesideIt) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    NormalBlock block({8, 8, 8}, 0.5);
    const std::vector<double> h =
        of(block.fill([&](const Indices& p) { return jumping_normal(p, axis, 3, 1.2); }));
    for (std::uint32_t layer = 0; layer < 8; ++layer) {
      Indices p{4, 4, 4};
      p[axis] = layer;
      const bool both_sides = GetParam() != ShockOperator::kIntermediate;
      const bool beside = layer == 3 || (both_sides && layer == 4);
      EXPECT_EQ(h[block.at(p)] < -0.05, beside) << "axis " << axis << " layer " << layer;
      EXPECT_TRUE(beside || std::abs(h[block.at(p)]) < 1e-15);
    }
  }
}

// All thresholds but that of intermediate differences (J = 1 as published) stand for Zucker-Hummel's jump.
TEST_P(EveryOperator, DefaultThresholdsStandForTheSameJump) {
  const double jump =
      GetParam() == ShockOperator::kIntermediate ? 1 : 7 / (1 + 4 * std::sqrt(0.5) + 4 * std::sqrt(1. / 3));
  for (const double spacing : {0.125, 1.0, 200.0}) {
    NormalBlock block({5, 5, 6}, spacing);
    const auto height = [&](double j) {
      const std::vector<double> h =
          of(block.fill([&](const Indices& p) { return jumping_normal(p, 2, 2, j); }));
      return std::abs(h[block.at({2, 2, 2})]);
    };
    const double threshold = default_threshold(GetParam(), spacing);
    EXPECT_LT(height(jump * 0.997), threshold);
    EXPECT_GT(height(jump * 1.003), threshold);
  }
}

TEST(NextThreshold, ContinuesThePublishedLadder) {
  EXPECT_EQ(next_threshold(7), 9);
  EXPECT_EQ(next_threshold(14), 18);
  EXPECT_TRUE(std::isfinite(next_threshold(1e308)));
}

}  // namespace
}  // namespace affskel::core

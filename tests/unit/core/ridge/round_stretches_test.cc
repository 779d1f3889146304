#include "core/ridge/round_stretches.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/error.h"

namespace affskel::core {
namespace {

// `count` vertices one apart on the x axis, radius 3.
RidgeCurve line(std::size_t count, const std::function<double(double)>& ratio, double strength = 10) {
  RidgeCurve curve;
  for (std::size_t n = 0; n < count; ++n) {
    SheetVertex v;
    v.position = {static_cast<double>(n), 0, 0};
    v.strength = strength;
    v.ratio = ratio(v.position.x);
    curve.vertices.push_back(v);
    curve.radius.push_back(3);
  }
  return curve;
}

RidgeConstants sharp() {
  RidgeConstants constants;
  constants.smoothing = 0;
  constants.low_ratio = 0.5;
  constants.high_ratio = 0.6;
  return constants;
}

TEST(RoundStretches, ReachFromTheHigherBoundToTheLowerOne) {
  // Two hills on 0.3: one reaches 0.6, the other stays below.
  const auto hills = [](double x) {
    return std::max({0.3, 0.7 - 0.02 * std::abs(x - 20), 0.55 - 0.02 * std::abs(x - 70)});
  };
  const std::vector<RidgeCurve> found = round_stretches(std::vector{line(100, hills)}, {}, sharp());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NEAR(found[0].vertices.front().position.x, 10, 1);
  EXPECT_NEAR(found[0].vertices.back().position.x, 30, 1);
  EXPECT_EQ(found[0].radius.size(), found[0].vertices.size());
}

TEST(RoundStretches, AreNotPartedByNoise) {
  // Every third vertex is flat, 0.7 on the mean.
  const auto noisy = [](double x) { return std::fmod(x, 3) == 0 ? 0.3 : 0.9; };
  const std::vector<RidgeCurve> found = round_stretches(std::vector{line(60, noisy)});
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].vertices.size(), 60U);
  EXPECT_NEAR(found[0].vertices[30].ratio, 0.7, 0.05);
  EXPECT_GT(round_stretches(std::vector{line(60, noisy)}, {}, sharp()).size(), 10U);
}

TEST(RoundStretches, AreStrongAndNoBalls) {
  const auto one = [](double) { return 1.0; };
  EXPECT_EQ(round_stretches(std::vector{line(20, one, 6.5)}).size(), 1U);
  EXPECT_TRUE(round_stretches(std::vector{line(20, one, 6.4)}).empty());
  RidgeCurve ball = line(20, one);
  for (SheetVertex& v : ball.vertices) v.roundness = 0.9;
  EXPECT_TRUE(round_stretches(std::vector{ball}).empty());
  RidgeCurve weak_end = line(20, one);
  weak_end.vertices[15].strength = 4;
  const std::vector<RidgeCurve> found = round_stretches(std::vector{weak_end});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].vertices.size(), 15U);
  EXPECT_EQ(found[1].vertices.size(), 4U);
}

TEST(RoundStretches, OfAClosedCurveGoThroughItsFirstVertex) {
  RidgeCurve ring = line(12, [](double) { return 0.8; });
  for (std::size_t n = 0; n < 12; ++n)
    ring.vertices[n].position = {std::cos(0.5236 * double(n)), std::sin(0.5236 * double(n)), 0};
  ring.closed = true;
  const std::vector<RidgeCurve> whole = round_stretches(std::vector{ring}, {}, sharp());
  ASSERT_EQ(whole.size(), 1U);
  EXPECT_TRUE(whole[0].closed);
  EXPECT_NEAR(curve_length(whole[0]), 24 * std::sin(3.14159265 / 12), 1e-3);
  ring.vertices[4].ratio = 0.1;
  const std::vector<RidgeCurve> open = round_stretches(std::vector{ring}, {}, sharp());
  ASSERT_EQ(open.size(), 1U);
  EXPECT_FALSE(open[0].closed);
  ASSERT_EQ(open[0].vertices.size(), 11U);
  EXPECT_EQ(open[0].vertices.front().position, ring.vertices[5].position);
  EXPECT_EQ(open[0].vertices.back().position, ring.vertices[3].position);
}

}  // namespace
}  // namespace affskel::core

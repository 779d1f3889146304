#include "core/surface/level_crossing.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace affskel::core {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(LevelCrossingBetweenTest, IsExactForCubics) {
  // E(t) = 5 - t - t^2 - t^3 / 2, hence 5 at 0 and 2.5 at 1.
  const auto e = [](double t) { return 5 - t - t * t - t * t * t / 2; };
  const EdgeValue above{5, -1}, below{2.5, -4.5};
  for (double t : {0.1, 0.37, 0.5, 0.99}) {
    const LevelCrossing found = level_crossing_between(above, below, e(t), false);
    EXPECT_NEAR(found.share, t, 1e-14);
    EXPECT_EQ(found.min_share, found.share);
    EXPECT_EQ(found.max_share, found.share);
  }
}

TEST(LevelCrossingBetweenTest, FollowsTheTangentsAcrossAKink) {
  // min(1 + t, 3 - 3 t): up to 1.5 at t = 1/2, then down to 0.
  EXPECT_NEAR(level_crossing_between({1, 1}, {0, -3}, 0.75, true).share, 0.75, 1e-15);
  // min(2 - t, 4 - 4 t), which meet at 2/3.
  EXPECT_NEAR(level_crossing_between({2, -1}, {0, -4}, 1.5, true).share, 0.5, 1e-15);
  EXPECT_NEAR(level_crossing_between({2, -1}, {0, -4}, 1.0, true).share, 0.75, 1e-15);
}

TEST(LevelCrossingBetweenTest, IsOpenAcrossAJump) {
  // 4 - t / 2 on one side, 1.5 - t / 2 on the other: nothing says where the one ends.
  const LevelCrossing wide = level_crossing_between({4, -0.5}, {1, -0.5}, 2, false);
  EXPECT_EQ(wide.min_share, 0);
  EXPECT_EQ(wide.max_share, 1);
  EXPECT_EQ(wide.share, 0.5);
  // The first side itself falls to the level at 1/2.
  const LevelCrossing half = level_crossing_between({4, -1}, {1, -0.5}, 3.5, false);
  EXPECT_EQ(half.max_share, 0.5);
  EXPECT_EQ(half.share, 0.25);
  const LevelCrossing unknown = level_crossing_between({kInfinity, 0}, {1, -1}, 2, false);
  EXPECT_EQ(unknown.share, 0.5);
  EXPECT_EQ(unknown.max_share, 1);
}

TEST(LevelCrossingBeforeSurfaceTest, IsExactForFacesSmoothPartsEdgesAndCorners) {
  constexpr double kSurface = 0.8;
  for (int power : {1, 2, 3}) {
    for (double t : {0.05, 0.4, 0.75}) {
      const EdgeValue at_end{7, -7 * power / kSurface};
      const double level = 7 * std::pow(1 - t / kSurface, power);
      EXPECT_NEAR(level_crossing_before_surface(at_end, kSurface, level), t, 1e-13) << power;
    }
  }
}

TEST(LevelCrossingBeforeSurfaceTest, GoesToTheSurfaceAsTheLevelFallsToZero) {
  for (double slope : {-1.0, -2.5, -3.0, -40.0}) {
    double last = 0;
    for (double level = 0.5; level > 1e-12; level /= 10) {
      const double t = level_crossing_before_surface({1, slope}, 1, level);
      EXPECT_GT(t, last);
      last = t;
    }
    EXPECT_NEAR(level_crossing_before_surface({1, slope}, 0.6, 0), 0.6, 1e-12);
  }
}

TEST(LevelCrossingBeforeSurfaceTest, StopsAtTheSurfaceWhereELeavesOffAboveTheLevel) {
  // The tangent is at 3 there.
  EXPECT_EQ(level_crossing_before_surface({4, -2}, 0.5, 1), 0.5);
  EXPECT_DOUBLE_EQ(level_crossing_before_surface({4, -2}, 0.5, 3.5), 0.25);
  EXPECT_EQ(level_crossing_before_surface({4, 1}, 0.5, 1), 0.5);
  EXPECT_EQ(level_crossing_before_surface({kInfinity, 0}, 0.5, 1), 0.5);
}

}  // namespace
}  // namespace affskel::core

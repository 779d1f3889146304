#include "core/base/plain_math.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace affskel::core {
namespace {

TEST(PlainMathTest, LogarithmAgreesWithTheLibrarys) {
  for (double x = 1e-300; x < 1e300; x *= 1.37) {
    EXPECT_NEAR(plain_log(x), std::log(x), 1e-15 * (1 + std::abs(std::log(x)))) << x;
  }
  EXPECT_EQ(plain_log(1), 0);
  for (double x = 0.5; x < 2; x += 1e-3) EXPECT_NEAR(plain_log(x), std::log(x), 4e-16) << x;
}

TEST(PlainMathTest, ExponentialAgreesWithTheLibrarys) {
  for (double x = -1; x <= 1; x += 1e-3) EXPECT_NEAR(plain_exp(x), std::exp(x), 2.3e-16 * std::exp(x)) << x;
  EXPECT_EQ(plain_exp(0), 1);
  EXPECT_EQ(plain_exp(1), std::numbers::e);
}

TEST(PlainMathTest, AngleAgreesWithTheLibrarys) {
  for (double degrees = 0; degrees <= 180; degrees += 0.37) {
    const auto [sine, cosine] = plain_sin_cos_degrees(degrees);
    for (const double size : {1e-100, 0.7, 1e100}) {
      EXPECT_NEAR(plain_angle(size * sine, size * cosine), std::atan2(sine, cosine), 1e-15) << degrees;
    }
  }
  EXPECT_EQ(plain_angle(0, 1), 0);
  EXPECT_EQ(plain_angle(0, -1), std::numbers::pi);
  EXPECT_EQ(plain_angle(1, 0), std::numbers::pi / 2);
  EXPECT_EQ(plain_angle(0, 0), 0);
  EXPECT_NEAR(plain_angle(1e-9, 1), 1e-9, 1e-24);
}

TEST(PlainMathTest, SineAndCosineAgreeWithTheLibrarys) {
  for (double degrees = -725; degrees <= 725; degrees += 0.37) {
    const auto [sine, cosine] = plain_sin_cos_degrees(degrees);
    const double x = std::fmod(degrees, 360) * std::numbers::pi / 180;
    EXPECT_NEAR(sine, std::sin(x), 2e-15) << degrees;
    EXPECT_NEAR(cosine, std::cos(x), 2e-15) << degrees;
    EXPECT_NEAR(sine * sine + cosine * cosine, 1, 5e-16) << degrees;
  }
}

TEST(PlainMathTest, RightAnglesAreExact) {
  using Pair = std::pair<double, double>;
  EXPECT_EQ(plain_sin_cos_degrees(0), Pair(0, 1));
  EXPECT_EQ(plain_sin_cos_degrees(90), Pair(1, 0));
  EXPECT_EQ(plain_sin_cos_degrees(-90), Pair(-1, 0));
  EXPECT_EQ(plain_sin_cos_degrees(180), Pair(0, -1));
  EXPECT_EQ(plain_sin_cos_degrees(270 + 3600), Pair(-1, 0));
}

}  // namespace
}  // namespace affskel::core

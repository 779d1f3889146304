#include "core/quality/similarity.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"

namespace affskel::core {
namespace {

TEST(SimilarityTest, SharesAndAreasOfAFewPoints) {
  const std::vector<Vec3> a = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0, 0}};
  const std::vector<Vec3> b = {{0, 0, 0}, {10, 1, 0}, {20, 0, 2}};
  const Similarity s = similarity(a, b);  // distances 0, 1, 2, sqrt(104) there, 0, 1, 2 back
  EXPECT_EQ(s.a_in_b.share_within(-1), 0);
  EXPECT_EQ(s.a_in_b.share_within(0), 0.25);
  EXPECT_EQ(s.a_in_b.share_within(1), 0.5);  // the radius belongs to the ball
  EXPECT_EQ(s.a_in_b.share_within(1.999), 0.5);
  EXPECT_EQ(s.a_in_b.share_within(11), 1);
  EXPECT_EQ(s.b_in_a.share_within(2), 1);
  EXPECT_EQ(s.a_in_b.hausdorff(), std::sqrt(104.0));
  EXPECT_EQ(s.b_in_a.hausdorff(), 2);
  // The steps' areas: from 0 to 1 a quarter, from 1 to 2 a half, from 2 to 4 three quarters.
  EXPECT_DOUBLE_EQ(s.a_in_b.area_under(4), (0.25 + 0.5 + 2 * 0.75) / 4);
  EXPECT_DOUBLE_EQ(s.a_in_b.area_under_squared(4), (0.25 + 3 * 0.5 + 12 * 0.75) / 16);
}

TEST(SimilarityTest, ASetIsLikeItself) {
  const std::vector<Vec3> a = {{0, 0, 0}, {1, 2, 3}};
  const Similarity s = similarity(a, a);
  EXPECT_EQ(s.a_in_b.share_within(0), 1);
  EXPECT_EQ(s.a_in_b.area_under(5), 1);
  EXPECT_EQ(s.a_in_b.area_under_squared(5), 1);
  EXPECT_EQ(s.b_in_a.hausdorff(), 0);
}

TEST(SimilarityTest, NothingIsLikeAnEmptySet) {
  const std::vector<Vec3> a = {{0, 0, 0}};
  EXPECT_THROW(similarity(a, {}), CoreError);
  EXPECT_THROW(similarity({}, a), CoreError);
}

TEST(SimilarityTest, HoldsAtAnySize) {
  // Squares of these coordinates leave the range of a double, at either end; powers of two keep every bit.
  std::vector<Vec3> a = {{0, 0, 0}, {10, 0, 0}, {20, 0, 0}, {30, 0, 0}};
  std::vector<Vec3> b = {{0, 0, 0}, {10, 1, 0}, {20, 0, 2}};
  const Similarity plain = similarity(a, b);
  for (const int exponent : {-1060, -560, 560, 1010}) {
    std::vector<Vec3> far_a, far_b;
    const auto moved = [&](const Vec3& p) {
      return Vec3{std::ldexp(p.x, exponent), std::ldexp(p.y, exponent), std::ldexp(p.z, exponent)};
    };
    for (const Vec3& p : a) far_a.push_back(moved(p));
    for (const Vec3& p : b) far_b.push_back(moved(p));
    const Similarity s = similarity(far_a, far_b);
    EXPECT_EQ(s.a_in_b.hausdorff(), std::ldexp(plain.a_in_b.hausdorff(), exponent)) << exponent;
    EXPECT_EQ(s.b_in_a.hausdorff(), std::ldexp(2, exponent)) << exponent;
    EXPECT_EQ(s.a_in_b.share_within(std::ldexp(1.999, exponent)), 0.5) << exponent;
  }
  // A distance far below the size of the set is not 0.
  const std::vector<Vec3> near = {{1e-170, 0, 0}, {10, 0, 0}};
  EXPECT_EQ(DistanceCurve(near, a).hausdorff(), 1e-170);
}

}  // namespace
}  // namespace affskel::core

#include "core/similarity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/shapes.h"

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

TEST(SimilarityTest, InnerPointsFillTheSolidEvenly) {
  Mesh box = make_box(3, 2, 1);
  for (Vec3& p : box.points) p = 1000 * p + Vec3{5, 5, 5};
  const std::vector<Vec3> points = inner_points(make_solid(box), {20000});
  EXPECT_NEAR(static_cast<double>(points.size()), 20000, 300);
  std::size_t eighth = 0;
  for (const Vec3& p : points) {
    EXPECT_TRUE(p.x > 5 && p.x < 3005 && p.y > 5 && p.y < 2005 && p.z > 5 && p.z < 1005);
    eighth += p.x < 1505 && p.y < 1005 && p.z < 505 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(eighth), static_cast<double>(points.size()) / 8, 100);
}

TEST(SimilarityTest, ChanceLevelOfAPointIsTheVolumeRoundIt) {
  // Inner points of a cube within r of its centre: the ball's share of the volume.
  const std::vector<Vec3> centre = {{1, 1, 1}};
  const DistanceCurve chance(inner_points(make_solid(make_box(2, 2, 2)), {30000}), centre);
  for (const double r : {0.3, 0.6, 0.9}) {
    EXPECT_NEAR(chance.share_within(r), 4 * std::numbers::pi / 3 * r * r * r / 8, 0.005);
  }
}

}  // namespace
}  // namespace affskel::core

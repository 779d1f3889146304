#include "core/spatial/point_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace affskel::core {
namespace {

double search_all(const std::vector<Vec3>& points, const Vec3& place) {
  double best = std::numeric_limits<double>::infinity();
  for (const Vec3& p : points) best = std::min(best, norm(p - place));
  return best;
}

TEST(PointIndexTest, FindsWhatASearchThroughAllFinds) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> anywhere(-3, 3);
  for (const std::size_t count : {1u, 8u, 9u, 17u, 3000u}) {
    std::vector<Vec3> points(count);
    for (Vec3& p : points) p = {anywhere(random), anywhere(random), 0.01 * anywhere(random)};
    const PointIndex index(points);
    for (int i = 0; i < 300; ++i) {
      const Vec3 place = {2 * anywhere(random), anywhere(random), anywhere(random)};
      EXPECT_EQ(index.nearest(place), search_all(points, place));
      EXPECT_EQ(norm(points.at(index.find(place).number) - place), index.nearest(place));
    }
    for (const Vec3& p : points) EXPECT_EQ(index.nearest(p), 0);
  }
}

TEST(PointIndexTest, EqualAndAlignedPointsAreNoTrouble) {
  std::vector<Vec3> points(100, Vec3{1, 2, 3});
  EXPECT_EQ(PointIndex(points).nearest({1, 2, 5}), 2);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {0, static_cast<double>(i % 7), 0};
  const PointIndex index(points);
  EXPECT_EQ(index.nearest({3, 5, 4}), 5);
  EXPECT_EQ(index.nearest({0, 9, 0}), 3);
}

TEST(PointIndexTest, TheDistanceDoesNotDependOnTheOrderOfThePoints) {
  std::mt19937_64 random(6);
  std::uniform_int_distribution<int> anywhere(0, 9);  // whole numbers: many ties
  std::vector<Vec3> points(500);
  for (Vec3& p : points) {
    p = {double(anywhere(random)), double(anywhere(random)), double(anywhere(random))};
  }
  const PointIndex one(points);
  std::reverse(points.begin(), points.end());
  const PointIndex other(points);
  for (int i = 0; i < 100; ++i) {
    const Vec3 place = {0.3 * i, 0.1 * i, 5};
    EXPECT_EQ(one.nearest(place), other.nearest(place));
  }
}

TEST(PointIndexTest, WithoutPointsEverythingIsInfinitelyFar) {
  EXPECT_EQ(PointIndex({}).nearest({0, 0, 0}), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace affskel::core

#include "core/spatial/locality_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

TEST(LocalityOrder, GoesThroughTheOctantsOneAfterAnother) {
  std::vector<Vec3> points;
  for (std::uint32_t i = 0; i < 512; ++i) {
    points.push_back(
        {static_cast<double>(i % 8), static_cast<double>(i / 64), static_cast<double>(i / 8 % 8)});
  }
  const std::vector<std::uint32_t> order = locality_order(points);
  ASSERT_EQ(order.size(), points.size());
  // Of every 8^k points in a row all lie in one cube of 2^k a side: 64 cubes of 2, 8 of 4.
  for (const std::size_t side : {2U, 4U}) {
    const std::size_t stretch = side * side * side;
    const auto cell = [&](double x) { return std::floor(x / static_cast<double>(side)); };
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Vec3 &p = points[order[i]], &first = points[order[i - i % stretch]];
      ASSERT_EQ(cell(p.x), cell(first.x));
      ASSERT_EQ(cell(p.y), cell(first.y));
      ASSERT_EQ(cell(p.z), cell(first.z));
    }
  }
}

TEST(LocalityOrder, IsAPermutationAndLeavesEqualPointsInOrder) {
  std::vector<Vec3> points = make_sphere(1, 320).points;
  const std::size_t once = points.size();
  points.insert(points.end(), points.begin(), points.begin() + static_cast<std::ptrdiff_t>(once));
  std::vector<std::uint32_t> order = locality_order(points);
  for (std::size_t i = 0; i < order.size(); i += 2) ASSERT_EQ(order[i] + once, order[i + 1]);
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) ASSERT_EQ(order[i], i);
}

TEST(LocalityOrder, OfPointsAtOnePlaceIsTheirOrder) {
  EXPECT_EQ(locality_order({{1, 2, 3}, {1, 2, 3}, {1, 2, 3}}), (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_TRUE(locality_order({}).empty());
}

}  // namespace
}  // namespace affskel::core

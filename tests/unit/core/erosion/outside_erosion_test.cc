#include "core/erosion/outside_erosion.h"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace affskel::core {
namespace {

struct Point {
  double erosion;
  Vec3 slopes;
};

using Points = std::map<PlaceAround, Point>;  // in lattice order
using Values = std::map<PlaceAround, double>;

Values continued(const std::array<std::uint32_t, 3>& dims, const Points& points) {
  Values values;
  OutsideErosion outside(dims, [&](const PlaceAround& at, double erosion) {
    EXPECT_TRUE(values.emplace(at, erosion).second) << "told once";
    EXPECT_EQ(values.rbegin()->first, at) << "in lattice order";
  });
  for (const auto& [at, point] : points) {
    outside.put({static_cast<std::uint32_t>(at[0]), static_cast<std::uint32_t>(at[1]),
                 static_cast<std::uint32_t>(at[2])},
                point.erosion, point.slopes);
  }
  outside.finish();
  return values;
}

// The definition, place by place.
Values by_definition(const std::array<std::uint32_t, 3>& dims, const Points& points) {
  Values values;
  for (std::int64_t i = -1; i <= dims[0]; ++i) {
    for (std::int64_t j = -1; j <= dims[1]; ++j) {
      for (std::int64_t k = -1; k <= dims[2]; ++k) {
        if (points.count({i, j, k}) != 0) continue;
        double sum = 0;
        int count = 0;
        for (int a = 0; a < 3; ++a) {
          for (const int step : {-1, 1}) {
            PlaceAround from = {i, j, k};
            from[static_cast<std::size_t>(a)] -= step;
            const auto found = points.find(from);
            if (found == points.end()) continue;
            sum += std::min(0.0, found->second.erosion + step * found->second.slopes[a]);
            ++count;
          }
        }
        if (count > 0) values[{i, j, k}] = sum / count;
      }
    }
  }
  return values;
}

// E = 3 depth below a plane that is no plane of the lattice: the continuation is the same linear function, so
// that every contour by linear interpolation is in place.
TEST(OutsideErosion, GoesOnAsATangentAtAFace) {
  Points points;
  const double surface = 2.3;
  for (std::int64_t i = 0; i <= 2; ++i) {
    for (std::int64_t j = 0; j < 3; ++j) {
      for (std::int64_t k = 0; k < 3; ++k) points[{i, j, k}] = {3 * (surface - double(i)), {-3, 0, 0}};
    }
  }
  const Values values = continued({4, 3, 3}, points);
  EXPECT_NEAR(values.at({3, 1, 1}), 3 * (surface - 3), 1e-15);
}

TEST(OutsideErosion, IsZeroWhereTheSurfaceIsNoEndOfE) {
  const Values values = continued({2, 1, 1}, {{{0, 0, 0}, {5, {-4, 0.5, 0}}}});
  EXPECT_EQ(values.at({1, 0, 0}), 0);
  EXPECT_EQ(values.at({0, 1, 0}), 0);
  EXPECT_EQ(values.at({0, 0, -1}), 0);
  EXPECT_EQ(values.size(), 6u);
}

TEST(OutsideErosion, IsTheMeanOverTheNeighboursInside) {
  // (1, 1, 0) lies beside both points: tangents -2 and 0.
  const Values values = continued({2, 2, 1}, {{{0, 1, 0}, {1, {-3, 0, 0}}}, {{1, 0, 0}, {4, {0, -1, 0}}}});
  EXPECT_EQ(values.at({1, 1, 0}), -1);
  EXPECT_EQ(values.at({0, 0, 0}), 0);
}

TEST(OutsideErosion, OfAnySetOfPointsIsWhatTheDefinitionSays) {
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> value(0, 1), slope(-3, 3);
  for (const double share : {0.02, 0.3, 0.8, 1.0}) {
    const std::array<std::uint32_t, 3> dims = {9, 4, 5};
    Points points;
    for (std::int64_t i = 0; i < 9; ++i) {
      for (std::int64_t j = 0; j < 4; ++j) {
        for (std::int64_t k = 0; k < 5; ++k) {
          if (value(random) < share)
            points[{i, j, k}] = {value(random), {slope(random), slope(random), slope(random)}};
        }
      }
    }
    const Values values = continued(dims, points), wanted = by_definition(dims, points);
    ASSERT_EQ(values.size(), wanted.size());
    for (const auto& [at, erosion] : wanted) ASSERT_NEAR(values.at(at), erosion, 1e-15);
  }
}

}  // namespace
}  // namespace affskel::core

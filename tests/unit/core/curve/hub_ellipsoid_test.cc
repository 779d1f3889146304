#include "core/curve/hub_ellipsoid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <numbers>

namespace affskel::core {
namespace {

TEST(HubEllipsoid, TheRimOfAFlatOneIsAsFarAsItIs) {
  const HubEllipsoid plate{{}, {{{1. / 400, 0, 0}, {0, 1. / 400, 0}, {0, 0, 1}}}};  // 20 wide, 1 high
  EXPECT_NEAR(plate.outside({15, 0, 1}), 1 - std::sqrt(1 - 0.75 * 0.75), 0.1)
      << "above it, not towards its centre";
  EXPECT_NEAR(plate.outside({21, 0, 0}), 1, 0.05);
  EXPECT_NEAR(plate.outside({0, 0, 3}), 2, 1e-12);
}

// A box of sample points, 10 x 20 x 30 of them, in cells of 0.5.
TEST(HubEllipsoid, HasTheMomentsOfItsPoints) {
  PlaceMoments points;
  for (int i = 0; i < 10; ++i)
    for (int j = 0; j < 20; ++j)
      for (int k = 0; k < 30; ++k) {
        const Vec3 at = 0.5 * Vec3{double(i), double(j), double(k)};
        points.add({1, at, outer(at, at)});
      }
  const HubEllipsoid box = HubEllipsoid::of(points, 0.5);
  EXPECT_LT(norm(box.centre - Vec3{2.25, 4.75, 7.25}), 1e-12);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double half = 1.1 * std::sqrt(5.0 / 12) * 5 * static_cast<double>(axis + 1);
    Vec3 end = box.centre;
    end[axis] += half;
    EXPECT_NEAR(box.outside(end), 0, 1e-9) << axis;
    EXPECT_NEAR(box.half_axes()[axis], half, 1e-9) << axis;
  }
  EXPECT_NEAR(box.filled_by(points, 0.5), std::pow(12.0 / 5, 1.5) / (4.0 / 3 * std::numbers::pi), 1e-9);
  EXPECT_FALSE(box.is_bar()) << "1.5 times as long as wide";
  EXPECT_NEAR(ball_radius(points.count, 0.5), std::cbrt(0.75 / std::numbers::pi * 5 * 10 * 15), 1e-9);
}

}  // namespace
}  // namespace affskel::core

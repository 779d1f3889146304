#include "core/solid/shrink_box.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/shapes/shapes.h"
#include "core/solid/least_box.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

TEST(ShrinkBox, FindsABoxFromNearby) {
  const Mesh mesh = make_box(3, 2, 1);
  const FittedBox box = shrink_box(mesh.points, {Vec3{1, 0.1, -0.05}, Vec3{-0.1, 1, 0.02}, Vec3{}});
  EXPECT_NEAR(box.volume, 6, 1e-12);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_LT(norm(box.axes[k] - kIdentity3[k]), 1e-12);
}

TEST(ShrinkBox, LeavesWhatIsLeastAlone) {
  const FittedBox box = shrink_box(make_box(3, 2, 1, 4).points, kIdentity3);
  EXPECT_EQ(box.axes, kIdentity3);
  EXPECT_EQ(box.volume, 6);
}

// The least box of a regular tetrahedron is the cube that it is inscribed in, of edge a / sqrt(2).
TEST(LeastBox, OfATetrahedronIsItsCube) {
  const Matrix3 axes = least_box_axes(shaken(make_tetrahedron(2), 0, 1));
  const FittedBox box = shrink_box(shaken(make_tetrahedron(2), 0, 1).points, axes);
  EXPECT_NEAR(box.volume, 2 * std::sqrt(2.0), 1e-9);
}

// The search along every direction of a grid of turns finds nothing smaller.
TEST(LeastBox, IsNotBeatenByAGridOfTurns) {
  const Mesh mesh = shaken(make_cone(1, 2.5, 7), 0.3, 5);
  const double least = shrink_box(mesh.points, least_box_axes(mesh)).volume;
  constexpr int kSteps = 12;
  for (int i = 0; i < kSteps; ++i) {
    for (int j = -kSteps; j < kSteps; ++j) {
      const double a = 3.2 * i / kSteps, z = (j + 0.5) / kSteps, r = std::sqrt(1 - z * z);
      const Vec3 axis{r * std::cos(a), r * std::sin(a), z};
      const Vec3 other = cross(axis, std::abs(z) < 0.7 ? Vec3{0, 0, 1} : Vec3{1, 0, 0});
      EXPECT_GE(shrink_box(mesh.points, {axis, other, {}}).volume, least * (1 - 1e-9));
    }
  }
}

}  // namespace
}  // namespace affskel::core

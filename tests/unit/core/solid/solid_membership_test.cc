#include "core/solid/solid_membership.h"

#include <gtest/gtest.h>

#include <random>

#include "core/mesh_checks.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Random points of the box [-side, side]^3.
void expect_like_solid_angles(const Mesh& mesh, double side) {
  const SolidMembership solid(mesh);
  std::mt19937_64 random(17);
  std::uniform_real_distribution<double> coordinate(-side, side);
  int inside = 0;
  for (int n = 0; n < 1500; ++n) {
    const Vec3 q{coordinate(random), coordinate(random), coordinate(random)};
    const bool wanted = winding_number(mesh, q) > 0.5;
    inside += wanted;
    EXPECT_EQ(solid.contains(q), wanted) << q.x << " " << q.y << " " << q.z;
  }
  EXPECT_GT(inside, 10);
}

TEST(SolidMembership, AgreesWithSolidAngles) {
  expect_like_solid_angles(hollow_ball(), 3);
  expect_like_solid_angles(make_torus(2, 0.7, 512), 3);
  expect_like_solid_angles(cup(16), 3.2);
  expect_like_solid_angles(shaken(make_torus(2, 0.7, 512), 0.01, 3), 3);
  expect_like_solid_angles(joined(make_box(1, 1, 1), moved(make_box(1, 1, 1), {-2, -2, -2})), 2.5);
}

// Rays along each axis from here run through vertices, along edges and within faces of a box; others beside it make the
// fewest lie along x, y and z.
TEST(SolidMembership, IsNotConfusedByEdgesAndVertices) {
  const Mesh box = make_box(4, 4, 4, 4), two = joined(box, moved(box, {8, 0, 0}));
  for (const Mesh& mesh : {box, two, joined(two, moved(box, {0, 8, 0}))}) {
    const SolidMembership solid(mesh);
    for (int axis = 0; axis < 3; ++axis) {
      for (int i = -1; i <= 4; ++i) {
        for (int j = 1; j <= 3; ++j) {
          for (int k = 1; k <= 3; ++k) {
            Vec3 q;
            q[axis] = i + 0.5;
            q[(axis + 1) % 3] = j;
            q[(axis + 2) % 3] = k;
            EXPECT_EQ(solid.contains(q), i >= 0 && i < 4) << axis << ": " << i << " " << j << " " << k;
          }
        }
      }
    }
  }
}

TEST(SolidMembership, CountsOverlapsAsInsideAndInsideOutAsOutside) {
  const Mesh twice = joined(make_box(2, 2, 2), moved(make_box(2, 2, 2), {1, 0.3, 0.3}));
  EXPECT_TRUE(SolidMembership(twice).contains({1.5, 1, 1}));
  EXPECT_FALSE(SolidMembership(reversed(make_box(2, 2, 2))).contains({1, 1, 1}));
}

TEST(SolidMembership, ToleranceTakesInTheSurface) {
  const Mesh box = make_box(2, 2, 2);
  const SolidMembership solid(box);
  for (const Vec3& q : {Vec3{2, 1, 1}, {0, 1, 1}, {1, 2, 1}, {1, 1, 0}, {2, 2, 2}, {0, 0, 0}}) {
    EXPECT_TRUE(solid.contains(q, 1e-12));
  }
  EXPECT_FALSE(solid.contains({2 + 1e-9, 1, 1}, 1e-12));
  EXPECT_FALSE(solid.contains({1, 1, -1e-9}, 1e-12));
}

}  // namespace
}  // namespace affskel::core

#include "core/shapes/mirror.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/mesh_checks.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

TEST(MirrorTest, HalvesAndRestoresAShape) {
  for (const double snap : {0.0, 0.02}) {
    const Mesh sphere = make_sphere(1, 1000);
    const Mesh half = positive_x_half(sphere, snap);
    for (const Vec3& p : half.points) EXPECT_GE(p.x, 0);
    EXPECT_NEAR(mesh_facts(half).area / mesh_facts(sphere).area, 0.5, 0.005);
    EXPECT_EQ(mesh_facts(half).euler, 1);  // a disc
    const Mesh whole = with_mirror_image(half);
    expect_solid_boundary(whole);
    EXPECT_NEAR(mesh_facts(whole).volume / mesh_facts(sphere).volume, 1, 0.005);
  }
}

TEST(MirrorTest, KeepsVolumeExactlyWhenTheCutIsAlongEdges) {
  Mesh box = make_box(2, 3, 4, 2);
  for (Vec3& p : box.points) p.x -= 1;
  const Mesh half = positive_x_half(box, 0);
  // Every vertex was there before: nothing had to be cut.
  for (const Vec3& p : half.points) {
    EXPECT_NE(std::find(box.points.begin(), box.points.end(), p), box.points.end());
  }
  EXPECT_NEAR(mesh_facts(with_mirror_image(half)).volume, 24, 1e-12);
}

TEST(MirrorTest, CutsATorusInTwoArcsAndJoinsThem) {
  const Mesh whole = with_mirror_image(positive_x_half(make_torus(3, 1, 1000), 0.01));
  expect_solid_boundary(whole, 1);
}

}  // namespace
}  // namespace affskel::core

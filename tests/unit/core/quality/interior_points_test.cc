#include "core/quality/interior_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/mesh/map_mesh.h"
#include "core/quality/similarity.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

TEST(InteriorPointsTest, FillTheSolidEvenly) {
  Mesh box = make_box(3, 2, 1);
  for (Vec3& p : box.points) p = 1000 * p + Vec3{5, 5, 5};
  const std::vector<Vec3> points = interior_points(make_solid(box), 20000);
  ASSERT_EQ(points.size(), 20000u);
  std::size_t eighth = 0;
  for (const Vec3& p : points) {
    EXPECT_TRUE(p.x > 5 && p.x < 3005 && p.y > 5 && p.y < 2005 && p.z > 5 && p.z < 1005);
    eighth += p.x < 1505 && p.y < 1005 && p.z < 505 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(eighth), static_cast<double>(points.size()) / 8, 100);
}

TEST(InteriorPointsTest, ChanceLevelOfAPointIsTheVolumeRoundIt) {
  // Inner points of a cube within r of its centre: the ball's share of the volume.
  const std::vector<Vec3> centre = {{1, 1, 1}};
  const DistanceCurve chance(interior_points(make_solid(make_box(2, 2, 2)), 30000), centre);
  for (const double r : {0.3, 0.6, 0.9}) {
    EXPECT_NEAR(chance.share_within(r), 4 * std::numbers::pi / 3 * r * r * r / 8, 0.005);
  }
}

// Needles and plates, along the axes and turned against them: as many points as for a cube, in every eighth
// of them equally many.
TEST(InteriorPointsTest, ThinSolidsGetTheirPointsToo) {
  const Vec3 sizes[] = {{1e5, 1, 1}, {1e6, 1e6, 1}, {1, 1e6, 1e6}, {1, 1e5, 1e2}};
  for (const Vec3& size : sizes) {
    for (const bool turned : {false, true}) {
      AffineMap turn;
      if (turned) turn.rows = {{{0.6, -0.8, 0}, {0.64, 0.48, -0.6}, {0.48, 0.36, 0.8}}};
      const Mesh mesh = map_mesh(turn, make_box(size.x, size.y, size.z));
      const std::vector<Vec3> points = interior_points(make_solid(mesh), 8000);
      ASSERT_EQ(points.size(), 8000u);
      const AffineMap back = inverse(turn);
      std::size_t eighth = 0;
      for (const Vec3& p : points) {
        const Vec3 q = back(p);
        const double slack = 1e-14 * (size.x + size.y + size.z);
        for (int k = 0; k < 3; ++k) EXPECT_TRUE(q[k] > -slack && q[k] < size[k] + slack) << size[k];
        eighth += 2 * q.x < size.x && 2 * q.y < size.y && 2 * q.z < size.z ? 1 : 0;
      }
      EXPECT_NEAR(static_cast<double>(eighth), 1000, 60);
    }
  }
}

TEST(InteriorPointsTest, LieInsideAlsoRoundHolesAndCavities) {
  Mesh shell = make_sphere(1, 320);
  const Mesh inner = make_sphere(0.999, 320);
  for (const Triangle& t : inner.triangles) {
    shell.triangles.push_back({t[0] + static_cast<std::uint32_t>(shell.points.size()),
                               t[2] + static_cast<std::uint32_t>(shell.points.size()),
                               t[1] + static_cast<std::uint32_t>(shell.points.size())});
  }
  shell.points.insert(shell.points.end(), inner.points.begin(), inner.points.end());
  for (const Mesh& mesh : {make_torus(3, 0.01, 256), shell}) {
    const SolidMembership membership(mesh);
    const std::vector<Vec3> points = interior_points(make_solid(mesh), 4000);
    ASSERT_EQ(points.size(), 4000u);
    std::size_t inside = 0;
    for (const Vec3& p : points) inside += membership.contains(p, 1e-12) ? 1 : 0;
    EXPECT_EQ(inside, points.size());
  }
}

}  // namespace
}  // namespace affskel::core

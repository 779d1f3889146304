#include "core/solid/surface_samples.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/shapes/shapes.h"
#include "core/spatial/point_index.h"

namespace affskel::core {
namespace {

TEST(SurfaceSamplesTest, EveryTriangleGetsItsShareAndHoldsItsPoints) {
  // A square of two triangles beside one of four times the area; z tells the faces apart.
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 5}, {2, 0, 5}, {0, 2, 5}}, {{0, 1, 2}, {3, 4, 5}}};
  EXPECT_EQ(surface_area(mesh), 2.5);
  const std::vector<Vec3> points = surface_samples(mesh, {1000});
  ASSERT_EQ(points.size(), 1000u);
  std::size_t small = 0;
  for (const Vec3& p : points) {
    const bool first = p.z == 0;
    small += first ? 1 : 0;
    EXPECT_GE(p.x, 0);
    EXPECT_GE(p.y, 0);
    EXPECT_LE(p.x + p.y, first ? 1 : 2);
    EXPECT_TRUE(first || p.z == 5);
  }
  EXPECT_EQ(small, 200u);
}

TEST(SurfaceSamplesTest, PointsAreSpreadEvenly) {
  // No place of the box's surface is farther from a sample than a few times the mean spacing.
  const Mesh box = make_box(3, 2, 1);
  const std::vector<Vec3> points = surface_samples(box, {5000});
  const double spacing = std::sqrt(surface_area(box) / 5000);
  const PointIndex index(points);
  for (const Vec3& p : surface_samples(box, {77777})) EXPECT_LT(index.nearest(p), 2.5 * spacing);
  for (const Vec3& p : box.points) EXPECT_LT(index.nearest(p), 2.5 * spacing);
}

TEST(SurfaceSamplesTest, TheirCentroidIsTheSurfaces) {
  Vec3 sum;
  for (const Vec3& p : surface_samples(make_box(3, 2, 1), {40000})) sum = sum + p;
  EXPECT_NEAR(norm((1.0 / 40000) * sum - Vec3{1.5, 1, 0.5}), 0, 1e-3);
}

TEST(SurfaceSamplesTest, ASurfaceWithoutAreaIsRefused) {
  EXPECT_THROW(surface_samples({}), CoreError);
  EXPECT_THROW(surface_samples({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}}), CoreError);
}

}  // namespace
}  // namespace affskel::core

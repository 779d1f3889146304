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
  const std::vector<Vec3> points = surface_samples(mesh, 1000);
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
  const std::vector<Vec3> points = surface_samples(box, 5000);
  const double spacing = std::sqrt(surface_area(box) / 5000);
  const PointIndex index(points);
  for (const Vec3& p : surface_samples(box, 77777)) EXPECT_LT(index.nearest(p), 2.5 * spacing);
  for (const Vec3& p : box.points) EXPECT_LT(index.nearest(p), 2.5 * spacing);
}

TEST(SurfaceSamplesTest, TheirCentroidIsTheSurfaces) {
  Vec3 sum;
  for (const Vec3& p : surface_samples(make_box(3, 2, 1), 40000)) sum = sum + p;
  EXPECT_NEAR(norm((1.0 / 40000) * sum - Vec3{1.5, 1, 0.5}), 0, 1e-3);
}

TEST(SurfaceSamplesTest, ASurfaceWithoutAreaIsRefused) {
  EXPECT_THROW(surface_samples({}), CoreError);
  EXPECT_THROW(surface_samples({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}}}), CoreError);
}

TEST(CurveSamplesTest, EverySegmentGetsItsShareHoweverManyThereAre) {
  const std::vector<Vec3> points = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0}, {9, 9, 9}};
  const std::vector<Segment> segments = {{0, 1}, {2, 1}};
  EXPECT_EQ(curve_length(points, segments), 4);
  const std::vector<Vec3> samples = curve_samples(points, segments, 8);
  ASSERT_EQ(samples.size(), 8u);
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_NEAR(norm(samples[i] - Vec3{0.25 + 0.5 * double(i), 0, 0}), 0, 1e-12);
  EXPECT_NEAR(norm(samples[6] - Vec3{3, 0.75, 0}), 0, 1e-12);
  EXPECT_NEAR(norm(samples[7] - Vec3{3, 0.25, 0}), 0, 1e-12);
  // A segment that is there a thousand times takes no more points.
  const std::vector<Segment> many(1000, {0, 1});
  EXPECT_EQ(curve_samples(points, many, 10).size(), 10u);
  EXPECT_THROW(curve_samples(points, std::vector<Segment>{{1, 1}}, {10}), CoreError);
}

}  // namespace
}  // namespace affskel::core

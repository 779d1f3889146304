#include "core/repair/cloud_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/error.h"
#include "core/base/split_mix64.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/repair/repair_mesh.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/stopping_context.h"

namespace affskel::core {
namespace {

// As a scanner leaves them: at random over the surface, off it by noise whose deviation is a share of the box's diagonal.
std::vector<Vec3> scanned(const Mesh& mesh, std::size_t count, double noise, std::uint64_t seed = 1) {
  std::vector<double> area_up_to;
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3& a = mesh.points[t[0]];
    area += norm(cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a));
    area_up_to.push_back(area);
  }
  SplitMix64 random(seed);
  const auto uniform = [&] { return 0.5 * (random.symmetric() + 1); };
  Mesh cloud;
  while (cloud.points.size() < count) {
    const auto at = std::lower_bound(area_up_to.begin(), area_up_to.end(), area * uniform());
    const Triangle& t = mesh.triangles[static_cast<std::size_t>(at - area_up_to.begin())];
    double u = uniform(), v = uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Vec3& a = mesh.points[t[0]];
    cloud.points.push_back(a + u * (mesh.points[t[1]] - a) + v * (mesh.points[t[2]] - a));
  }
  return perturb(cloud, {.sigma = noise * box_diagonal(mesh), .seed = seed}).points;
}

Mesh points_of(std::vector<Vec3> points) {
  Mesh cloud;
  cloud.points = std::move(points);
  return cloud;
}

long characteristic(const Mesh& mesh) {
  return static_cast<long>(mesh.points.size()) - static_cast<long>(mesh.triangles.size() / 2);
}

std::string refusal(const std::vector<Vec3>& points) {
  try {
    cloud_surface(points);
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kBadInput);
    return error.what();
  }
  return "";
}

// The wrap of points alone lay round the outermost and entered between the others: three times the volume.
TEST(CloudSurface, OfANoisyBodyHasItsVolumeAndNoHandles) {
  const Mesh body = make_body({.triangles = 5000});
  const std::vector<Vec3> points = scanned(body, 5'000, 0.002);
  const CloudSurface found = cloud_surface(points);
  EXPECT_EQ(found.lone, 0);
  EXPECT_EQ(found.used, 5'000);
  EXPECT_EQ(found.unseen, 0);
  EXPECT_NEAR(make_solid(found.mesh).volume / make_solid(body).volume, 1, 0.01);
  const RepairedMesh wrapped = repair_mesh(points_of(points), {.kind = RepairKind::kWrap, .alpha = 30});
  EXPECT_NEAR(make_solid(wrapped.mesh).volume / make_solid(body).volume, 1, 0.02);
  EXPECT_EQ(characteristic(wrapped.mesh), 2);
}

// Neighbours within the noise tell nothing: few of many points stay.
TEST(CloudSurface, OfADenseNoisyBodyIsLaidThroughFewer) {
  const Mesh body = make_body({.triangles = 5000});
  const CloudSurface found = cloud_surface(scanned(body, 80'000, 0.003));
  EXPECT_LT(found.used, 40'000);
  EXPECT_NEAR(make_solid(found.mesh).volume / make_solid(body).volume, 1, 0.02);
}

// Each of two solids, far apart, looks outward, whatever its points' scale and place, and however often they come.
TEST(CloudSurface, OfTwoSolidsHoldsBoth) {
  const Mesh torus = make_torus(3, 1, 4096);
  std::vector<Vec3> points = scanned(torus, 2000, 0);
  for (const Vec3& p : scanned(torus, 2000, 0, 2)) points.push_back(p + Vec3{0, 0, 20});
  for (const double scale : {1e-30, 1.0, 1e30}) {
    std::vector<Vec3> scaled;
    for (const Vec3& p : points)
      for (int copy = 0; copy < 3; ++copy) scaled.push_back(scale * (p + Vec3{1e5, 0, 0}));
    const CloudSurface found = cloud_surface(scaled);
    EXPECT_EQ(characteristic(found.mesh), 0) << scale;
    double volume = 0;
    for (const Triangle& t : found.mesh.triangles) {
      const Vec3 a = (1 / scale) * found.mesh.points[t[0]] - Vec3{1e5, 0, 0};
      const Vec3 b = (1 / scale) * found.mesh.points[t[1]] - Vec3{1e5, 0, 0};
      volume += dot(a, cross(b, (1 / scale) * found.mesh.points[t[2]] - Vec3{1e5, 0, 0})) / 6;
    }
    EXPECT_NEAR(volume / (2 * make_solid(torus).volume), 1, 0.02) << scale;
  }
}

TEST(CloudSurface, LeavesOutPointsThatLieAlone) {
  const Mesh ball = make_sphere(10, 5120);
  std::vector<Vec3> points = scanned(ball, 5000, 0.001);
  SplitMix64 random(3);
  for (int i = 0; i < 100; ++i)
    points.push_back({60 * random.symmetric(), 60 * random.symmetric(), 60 + 40 * random.symmetric()});
  const CloudSurface found = cloud_surface(points);
  EXPECT_GE(found.lone, 95);
  EXPECT_LE(found.lone, 100);
  EXPECT_NEAR(make_solid(found.mesh).volume / make_solid(ball).volume, 1, 0.02);
}

// Of a scan that saw nothing below, the surface is closed there, and what is made up is told.
TEST(CloudSurface, TellsWhatNoPointIsNear) {
  const Mesh ball = make_sphere(10, 5120);
  const auto above = [&](double height) {
    std::vector<Vec3> points = scanned(ball, 8000, 0);
    std::erase_if(points, [&](const Vec3& p) { return p.z < height; });
    return points;
  };
  const CloudSurface found = cloud_surface(above(-8));
  EXPECT_GT(found.unseen, 0.02);
  EXPECT_LT(found.unseen, 0.1);
  EXPECT_NE(refusal(above(4)).find("no point is near"), std::string::npos);
}

TEST(CloudSurface, RefusesWhatIsNoSurface) {
  const std::vector<Vec3> few = scanned(make_sphere(10, 1280), 99, 0);
  EXPECT_NE(refusal(few).find("99 points"), std::string::npos);
  std::vector<Vec3> plane, line, space;
  SplitMix64 random(4);
  for (int i = 0; i < 5000; ++i) {
    plane.push_back({random.symmetric(), random.symmetric(), 0.5});
    line.push_back({random.symmetric(), 0.25, 0.5});
    space.push_back({random.symmetric(), random.symmetric(), random.symmetric()});
  }
  EXPECT_NE(refusal(plane).find("one plane"), std::string::npos);
  EXPECT_NE(refusal(line).find("one plane"), std::string::npos);
  EXPECT_NE(refusal(space).find("too noisy"), std::string::npos);
  // In heaps of seven each point has six near ones, and the next six far away.
  std::vector<Vec3> heaps;
  for (int i = 0; i < 1400; ++i)
    heaps.push_back(double(i / 7 % 10) * Vec3{1, 0, 0} + double(i / 70) * Vec3{0, 1, 1} +
                    1e-3 * Vec3{random.symmetric(), random.symmetric(), random.symmetric()});
  EXPECT_NE(refusal(heaps).find("near others"), std::string::npos);
}

TEST(CloudSurface, IsTheSameEachTime) {
  const std::vector<Vec3> points = scanned(make_body({.triangles = 1000}), 2500, 0.002);
  const Mesh once = cloud_surface(points).mesh, again = cloud_surface(points).mesh;
  ASSERT_EQ(once.points.size(), again.points.size());
  for (std::size_t v = 0; v < once.points.size(); ++v) ASSERT_EQ(norm(once.points[v] - again.points[v]), 0);
  EXPECT_EQ(once.triangles, again.triangles);
}

TEST(CloudSurface, StopsWhenAsked) {
  const std::vector<Vec3> points = scanned(make_sphere(10, 1280), 1000, 0);
  expect_stops_wherever_it_is_asked(3000, [&](ExecutionContext* context) { cloud_surface(points, context); });
}

}  // namespace
}  // namespace affskel::core

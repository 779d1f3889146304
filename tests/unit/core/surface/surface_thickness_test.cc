#include "core/surface/surface_thickness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/unit.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

std::vector<Vec3> inward_normals(const Mesh& mesh) {
  std::vector<Vec3> normals;
  for (const auto& [a, b, c] : mesh.triangles)
    normals.push_back(unit(cross(mesh.points[c] - mesh.points[a], mesh.points[b] - mesh.points[a])));
  return normals;
}

Vec3 in_solid(const Solid& solid, const Vec3& place) {
  return (1 / solid.scale()) * (place - solid.centre);
}

std::vector<double> unknown(std::size_t triangles) {
  return std::vector<double>(triangles, std::numeric_limits<double>::infinity());
}

// In mesh units.
std::vector<double> thickness(const Solid& solid, Mesh skeleton, const std::vector<Vec3>& inward,
                              ThicknessOptions options = {}) {
  for (Vec3& point : skeleton.points) point = in_solid(solid, point);
  if (options.near == 0) options.near = 0.02 / solid.scale();
  std::vector<double> result =
      surface_thickness(solid, solid.mesh, skeleton, inward, unknown(inward.size()), options);
  for (double& value : result) value *= solid.scale();
  return result;
}

// The middle rectangle of a plate 8 x 8 x 2; under its rims the way misses it.
TEST(SurfaceThickness, OfAPlateIsHalfOfIt) {
  const Solid plate = make_solid(make_box(8, 8, 2, 8));
  const Mesh middle{{{1, 1, 1}, {7, 1, 1}, {7, 7, 1}, {1, 7, 1}}, {{0, 1, 2}, {0, 2, 3}}};
  const std::vector<Vec3> inward = inward_normals(plate.mesh);
  const std::vector<double> found = thickness(plate, middle, inward);
  int faces = 0;
  for (std::size_t t = 0; t < found.size(); ++t) {
    const auto& [a, b, c] = plate.mesh.triangles[t];
    const Vec3 at = plate.centre + (plate.scale() / 3) *
                                       (plate.mesh.points[a] + (plate.mesh.points[b] + plate.mesh.points[c]));
    if (std::abs(inward[t].z) < 0.5 || std::max(std::abs(at.x - 4), std::abs(at.y - 4)) > 3) continue;
    EXPECT_NEAR(found[t], 1, 1e-9);
    ++faces;
  }
  EXPECT_GE(faces, 100);
}

// An axis as triangles of two corners; normals that are up to 20 degrees off pass it, and end beside it.
TEST(SurfaceThickness, OfACylinderIsItsRadius) {
  const Solid cylinder = make_solid(make_cylinder(1, 10, 64));
  const Mesh axis{{{0, 0, 1}, {0, 0, 9}}, {{0, 1, 1}}};
  for (const double tilt : {0.0, 20.0}) {
    std::vector<Vec3> inward = inward_normals(cylinder.mesh);
    const double angle = tilt * std::numbers::pi / 180;
    for (Vec3& n : inward) {
      const Vec3 across = unit(cross({0, 0, 1}, n));
      n = std::cos(angle) * n + std::sin(angle) * across;
    }
    const std::vector<double> found = thickness(cylinder, axis, inward);
    for (std::size_t t = 0; t < found.size(); ++t) {
      if (std::abs(inward[t].z) > 0.5) continue;
      EXPECT_NEAR(found[t], std::cos(angle), 0.03) << tilt;  // the foot of the axis on the way
    }
  }
}

// Where the optimal normal leads out of the solid, it is taken the other way round; none tells nothing: then it is the distance.
TEST(SurfaceThickness, OutwardNormalsAreTurned) {
  const Solid ball = make_solid(make_sphere(2, 320));
  const Mesh centre{{{0, 0, 0}}, {{0, 0, 0}}};
  std::vector<Vec3> outward = inward_normals(ball.mesh);
  const std::vector<double> within = thickness(ball, centre, outward);
  for (Vec3& n : outward) n = -1.0 * n;
  const std::vector<double> without = thickness(ball, centre, outward);
  const std::vector<double> none = thickness(ball, centre, std::vector<Vec3>(outward.size()));
  for (std::size_t t = 0; t < within.size(); ++t) {
    EXPECT_NEAR(within[t], 2, 0.06);
    EXPECT_EQ(without[t], within[t]);
    EXPECT_NEAR(none[t], within[t], 1e-3);
  }
}

// Two plates, 2 thick, a gap of 0.5 apart, touching, or crossing, and a skeleton in the upper one alone: from below the lower
// one the way leaves that before it comes there only where there is a gap, and its middle counts.
TEST(SurfaceThickness, EndsWhereTheWayLeavesTheSolid) {
  for (const double gap : {0.5, 0., -0.5}) {
    const Mesh plate = make_box(8, 8, 2, 8), mesh = joined(plate, moved(plate, {0, 0, 2 + gap}));
    const Solid plates = make_solid(mesh);
    const Mesh middle{{{0, 0, 3 + gap}, {8, 0, 3 + gap}, {8, 8, 3 + gap}}, {{0, 1, 2}}};
    const std::vector<double> found =
        thickness(plates, middle, std::vector<Vec3>(mesh.triangles.size(), {0.6, 0, 0.8}));
    const Vec3 below{4, 2, 0};
    int count = 0;
    for (std::size_t t = 0; t < found.size(); ++t) {
      const auto& [a, b, c] = mesh.triangles[t];
      const Vec3 at = (1. / 3) * (mesh.points[a] + (mesh.points[b] + mesh.points[c]));
      if (norm(at - below) > 1) continue;
      EXPECT_NEAR(found[t], (gap > 0 ? 1 : 3 + gap) / 0.8, 0.05);
      ++count;
    }
    EXPECT_GE(count, 4);
  }
}

// A box within another, as a surface that crosses itself has them: from the inner one's faces ways go on to the outer one's.
TEST(SurfaceThickness, BeginsWithinAnotherSolid) {
  const Mesh inner = moved(make_box(2, 2, 2), {3, 3, 1}), outer = make_box(8, 8, 4);
  const Solid both = make_solid(joined(outer, inner));
  for (const double up : {-1., 1.}) {
    const Mesh surface{{in_solid(both, {3.5, 4, 2 - up}), in_solid(both, {4.1, 4.6, 2 - up}),
                        in_solid(both, {4.4, 3.4, 2 - up})},
                       {up > 0 ? Triangle{0, 1, 2} : Triangle{0, 2, 1}}};
    const double far = 2 + up * 2.5;  // beyond the outer face, which is 3 away from the inner one
    const Mesh there{{in_solid(both, {0, 0, far}), in_solid(both, {8, 0, far}), in_solid(both, {8, 8, far}),
                      in_solid(both, {0, 8, far})},
                     {{0, 1, 2}, {0, 2, 3}}};
    ThicknessOptions options;
    options.near = 0.02 / both.scale();
    // 3.5 away, and at a slope of 0.8 the way comes as near as 0.5 before it leaves the outer box after 3.75.
    EXPECT_NEAR(surface_thickness(both, surface, there, std::vector<Vec3>{{0.6, 0, 0.8 * up}}, unknown(1),
                                  options)[0] *
                    both.scale(),
                3.5, 0.9);
  }
}

// Ways from a coarse box's edges: the finer surface has triangles that lie on them.
TEST(SurfaceThickness, BeginsOnAnEdgeOfTheSolid) {
  const Solid box = make_solid(make_box(8, 8, 2));
  const Mesh surface{{in_solid(box, {3, 3, 0}), in_solid(box, {4, 5, 0}), in_solid(box, {5, 4, 0})},
                     {{0, 1, 2}}};
  const Mesh above{{in_solid(box, {0, 0, 4.5}), in_solid(box, {8, 0, 4.5}), in_solid(box, {8, 8, 4.5})},
                   {{0, 1, 2}}};
  ThicknessOptions options;
  options.near = 0.02 / box.scale();
  const std::vector<Vec3> tilted{{0.6, 0, 0.8}};
  EXPECT_NEAR(surface_thickness(box, surface, above, tilted, unknown(1), options)[0] * box.scale(), 1 / 0.8,
              1e-3)
      << "it leaves the box 2 up";
}

// A bent wall has no ridge: half of it counts, from both of its sides, whose optimal normal is that of the outer one; but not
// along ways that are steep to the surface.
TEST(SurfaceThickness, OfAWallWithoutSkeletonIsHalfOfIt) {
  const Solid shell = make_solid(joined(make_sphere(5, 1280), reversed(make_sphere(4, 1280))));
  const Mesh pole{{{0, 0, 4.5}}, {{0, 0, 0}}};
  const auto at = [&](std::size_t t) {
    const auto& [a, b, c] = shell.mesh.triangles[t];
    return shell.centre +
           (shell.scale() / 3) * (shell.mesh.points[a] + (shell.mesh.points[b] + shell.mesh.points[c]));
  };
  std::vector<Vec3> inward, steep;
  for (std::size_t t = 0; t < shell.mesh.triangles.size(); ++t) {
    inward.push_back(-1.0 * unit(at(t)));
    steep.push_back(unit(inward.back() + 2.0 * unit(cross(at(t), Vec3{0.6, 0, 0.8}))));
  }
  const std::vector<double> found = thickness(shell, pole, inward), steeply = thickness(shell, pole, steep);
  for (std::size_t t = 0; t < found.size(); ++t) {
    if (at(t).z > 0) continue;
    EXPECT_NEAR(found[t], 0.5, 0.03);
    EXPECT_NEAR(steeply[t], norm(at(t) - Vec3{0, 0, 4.5}), 1e-9);
  }
}

// The axis of a cylinder, from its flat ends: the way along it is long.
TEST(SurfaceThickness, IsNotMuchMoreThanTheSolidIsThickThere) {
  const Solid cylinder = make_solid(make_cylinder(1, 10, 64));
  const Mesh axis{{{0, 0, 4}, {0, 0, 6}}, {{0, 1, 1}}};
  Mesh skeleton = axis;
  for (Vec3& point : skeleton.points) point = in_solid(cylinder, point);
  const std::vector<Vec3> inward = inward_normals(cylinder.mesh);
  ThicknessOptions options;
  options.near = 0.02 / cylinder.scale();
  for (const double about : {1., 3.}) {
    const std::vector<double> found =
        surface_thickness(cylinder, cylinder.mesh, skeleton, inward,
                          std::vector<double>(inward.size(), about / cylinder.scale()), options);
    int ends = 0;
    for (std::size_t t = 0; t < found.size(); ++t) {
      if (std::abs(inward[t].z) < 0.5) continue;
      EXPECT_NEAR(found[t] * cylinder.scale(), about == 1 ? 1 : 4, 0.03) << about;
      ++ends;
    }
    EXPECT_GE(ends, 60);
  }
}

TEST(SurfaceThickness, DoesNotDependOnThreadsAndStops) {
  const Solid torus = make_solid(make_torus(3, 1, 4000));
  const Mesh centre{{{3, 0, 0}, {-3, 0, 0}, {0, 3, 0}}, {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}};
  const std::vector<Vec3> inward = inward_normals(torus.mesh);
  ThicknessOptions options;
  const std::vector<double> one = thickness(torus, centre, inward, options);
  options.threads = 3;
  EXPECT_EQ(thickness(torus, centre, inward, options), one);
  options.threads = 1;
  expect_stops_wherever_it_is_asked(5, [&](ExecutionContext* context) {
    options.context = context;
    thickness(torus, centre, inward, options);
  });
}

}  // namespace
}  // namespace affskel::core

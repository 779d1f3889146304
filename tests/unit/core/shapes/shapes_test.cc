#include "core/shapes/shapes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <string>

#include "core/base/error.h"
#include "core/mesh_checks.h"

namespace affskel::core {
namespace {

constexpr double kPi = std::numbers::pi;

double polygon_area(double radius, double sides) {
  return sides / 2 * radius * radius * std::sin(2 * kPi / sides);
}

std::string refusal(const std::function<Mesh()>& make) {
  try {
    make();
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kBadInput);
    return error.what();
  }
  ADD_FAILURE() << "accepted";
  return "";
}

TEST(TorusTest, Has16By8SegmentsAt256Triangles) {
  for (const double major : {1.2, 3.0, 10.0}) {
    const Mesh mesh = make_torus(major, 1, 256);
    EXPECT_EQ(mesh.triangles.size(), 256u);
    const auto outermost = std::count_if(mesh.points.begin(), mesh.points.end(), [&](const Vec3& p) {
      return std::abs(std::hypot(p.x, p.y) - (major + 1)) < 1e-12;
    });
    EXPECT_EQ(outermost, 16);
    EXPECT_EQ(mesh.points.size(), 16u * 8u);
  }
}

TEST(TorusTest, HasTheVolumeOfSweptPolygons) {
  const Mesh mesh = make_torus(5000, 2000, 256);
  expect_solid_boundary(mesh, 1);
  const double expected = 16 * std::sin(2 * kPi / 16) * 5000 * polygon_area(2000, 8);
  EXPECT_NEAR(mesh_facts(mesh).volume / expected, 1, 1e-12);
}

TEST(TorusTest, MakesExactlyTheCountOrRefuses) {
  int made = 0;
  for (std::uint32_t triangles = 18; triangles <= 600; triangles += 2) {
    try {
      const Mesh mesh = make_torus(3, 1, triangles);
      EXPECT_EQ(mesh.triangles.size(), triangles);
      expect_solid_boundary(mesh, 1);
      ++made;
    } catch (const CoreError& error) {
      EXPECT_EQ(error.code(), CoreError::Code::kBadInput);
    }
  }
  EXPECT_GT(made, 150);
}

TEST(TorusTest, NamesCountsThatWorkWhenItRefusesOne) {
  for (const std::uint32_t triangles : {254u, 6054u}) {  // 2 * 127, 2 * 3 * 1009
    const std::string message = refusal([=] { return make_torus(3, 1, triangles); });
    EXPECT_NE(message.find(std::to_string(triangles)), std::string::npos) << message;
    const std::size_t at = message.find("try ");
    ASSERT_NE(at, std::string::npos) << message;
    const auto suggested = static_cast<std::uint32_t>(std::stoul(message.substr(at + 4)));
    EXPECT_EQ(make_torus(3, 1, suggested).triangles.size(), suggested);
  }
}

TEST(TorusTest, RefusesBadArguments) {
  refusal([] { return make_torus(3, 1, 16); });
  refusal([] { return make_torus(3, 1, 257); });
  refusal([] { return make_torus(1, 1, 256); });
  refusal([] { return make_torus(3, 0, 256); });
  refusal([] { return make_torus(3, -1, 256); });
  refusal([] { return make_torus(std::numeric_limits<double>::infinity(), 1, 256); });
  refusal([] { return make_torus(3, std::nan(""), 256); });
}

TEST(SphereTest, IsTheIcosahedronFirst) {
  const Mesh mesh = make_sphere(2, 1);
  EXPECT_EQ(mesh.triangles.size(), 20u);
  const double edge = 2 / std::sin(2 * kPi / 5);
  EXPECT_NEAR(mesh_facts(mesh).volume, 5.0 / 12 * (3 + std::sqrt(5.0)) * std::pow(edge, 3), 1e-12);
}

TEST(SphereTest, HasTheLeastSufficientFrequency) {
  EXPECT_EQ(make_sphere(1, 20).triangles.size(), 20u);
  EXPECT_EQ(make_sphere(1, 21).triangles.size(), 80u);
  EXPECT_EQ(make_sphere(1, 1000).triangles.size(), 1280u);
  EXPECT_EQ(make_sphere(1, 5120).triangles.size(), 5120u);
}

TEST(SphereTest, IsInscribedInTheBallAndFillsIt) {
  const Mesh mesh = make_sphere(3, 5000);
  expect_solid_boundary(mesh);
  double inradius = 3;
  for (const Vec3& p : mesh.points) EXPECT_NEAR(norm(p), 3, 1e-14);
  for (const Triangle& t : mesh.triangles) {
    const Vec3 n = cross(mesh.points[t[1]] - mesh.points[t[0]], mesh.points[t[2]] - mesh.points[t[0]]);
    inradius = std::min(inradius, dot(n, mesh.points[t[0]]) / norm(n));
  }
  EXPECT_GT(inradius, 0.997 * 3);
  const double ball = 4 * kPi / 3;
  EXPECT_LT(mesh_facts(mesh).volume, ball * 27);
  EXPECT_GT(mesh_facts(mesh).volume, ball * std::pow(inradius, 3));
}

TEST(EllipsoidTest, IsTheSphereScaled) {
  const Mesh mesh = make_ellipsoid(1, 2, 5, 500);
  expect_solid_boundary(mesh);
  EXPECT_NEAR(mesh_facts(mesh).volume / (10 * mesh_facts(make_sphere(1, 500)).volume), 1, 1e-14);
  for (const Vec3& p : mesh.points) EXPECT_NEAR(p.x * p.x + p.y * p.y / 4 + p.z * p.z / 25, 1, 1e-14);
}

TEST(BoxTest, FillsItsExtentAtEveryDivision) {
  for (const std::uint32_t n : {1u, 2u, 7u}) {
    const Mesh mesh = make_box(0.1, 2, 3000, n);
    expect_solid_boundary(mesh);
    EXPECT_EQ(mesh.triangles.size(), 12u * n * n);
    EXPECT_EQ(mesh.points.size(), 6u * n * n + 2);
    EXPECT_NEAR(mesh_facts(mesh).volume / 600, 1, 1e-14);
    EXPECT_NEAR(mesh_facts(mesh).area / (2 * (0.2 + 6000 + 300)), 1, 1e-13);
    std::set<double> xs, zs;
    for (const Vec3& p : mesh.points) {
      xs.insert(p.x);
      zs.insert(p.z);
    }
    EXPECT_EQ(*xs.begin(), 0);
    EXPECT_EQ(*xs.rbegin(), 0.1);
    EXPECT_EQ(*zs.rbegin(), 3000);
    EXPECT_EQ(xs.size(), n + 1u);
  }
}

TEST(CylinderTest, HasThePrismsVolume) {
  for (const std::uint32_t segments : {3u, 4u, 37u}) {
    const Mesh mesh = make_cylinder(2, 5, segments);
    expect_solid_boundary(mesh);
    EXPECT_EQ(mesh.triangles.size(), 4u * segments);
    EXPECT_NEAR(mesh_facts(mesh).volume / (polygon_area(2, segments) * 5), 1, 1e-14);
  }
}

TEST(ConeTest, HasThePyramidsVolume) {
  for (const std::uint32_t segments : {3u, 4u, 37u}) {
    const Mesh mesh = make_cone(2, 5, segments);
    expect_solid_boundary(mesh);
    EXPECT_EQ(mesh.triangles.size(), 2u * segments);
    EXPECT_NEAR(mesh_facts(mesh).volume / (polygon_area(2, segments) * 5 / 3), 1, 1e-14);
  }
}

TEST(TetrahedronTest, IsRegularAndCentred) {
  const Mesh mesh = make_tetrahedron(7);
  expect_solid_boundary(mesh);
  Vec3 sum;
  for (std::size_t i = 0; i < 4; ++i) {
    sum = sum + mesh.points[i];
    for (std::size_t j = 0; j < i; ++j) EXPECT_NEAR(norm(mesh.points[i] - mesh.points[j]), 7, 1e-14);
  }
  EXPECT_NEAR(norm(sum), 0, 1e-14);
  EXPECT_NEAR(mesh_facts(mesh).volume, 343 / (6 * std::sqrt(2.0)), 1e-12);
}

TEST(ShapesTest, RefuseBadArguments) {
  const double nan = std::nan("");
  refusal([] { return make_sphere(0, 20); });
  refusal([=] { return make_sphere(nan, 20); });
  refusal([] { return make_ellipsoid(1, 1, -1, 20); });
  refusal([] { return make_box(1, 0, 1); });
  refusal([] { return make_box(1, 1, 1, 0); });
  refusal([] { return make_cylinder(1, 1, 2); });
  refusal([] { return make_cylinder(1, -1, 8); });
  refusal([] { return make_cone(1, 1, 2); });
  refusal([=] { return make_cone(nan, 1, 8); });
  refusal([] { return make_tetrahedron(-1); });
  EXPECT_EQ(refusal([] { return make_box(1, -2.5, 1); }),
            "box: the side along y must be a finite number > 0, not -2.5");
}

TEST(ShapesTest, RefuseMoreThanTheLimit) {
  const std::uint32_t most = std::numeric_limits<std::uint32_t>::max();
  for (const std::function<Mesh()>& make : {std::function<Mesh()>([=] { return make_torus(3, 1, most - 1); }),
                                            std::function<Mesh()>([=] { return make_sphere(1, most); }),
                                            std::function<Mesh()>([=] { return make_box(1, 1, 1, most); }),
                                            std::function<Mesh()>([=] { return make_cylinder(1, 1, most); }),
                                            std::function<Mesh()>([=] { return make_cone(1, 1, most); })}) {
    try {
      make();
      ADD_FAILURE() << "accepted";
    } catch (const CoreError& error) {
      EXPECT_EQ(error.code(), CoreError::Code::kLimit) << error.what();
    }
  }
}

}  // namespace
}  // namespace affskel::core

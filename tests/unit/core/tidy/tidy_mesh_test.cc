#include "core/tidy/tidy_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <tuple>

#include "core/mesh_checks.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

struct Shape {
  double shortest_edge = 1e300;
  double least_angle = 180;  // degrees
};

Shape shape_of(const Mesh& mesh) {
  Shape shape;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 u = mesh.points[t[(k + 1) % 3]] - mesh.points[t[k]];
      const Vec3 v = mesh.points[t[(k + 2) % 3]] - mesh.points[t[k]];
      shape.shortest_edge = std::min(shape.shortest_edge, norm(u));
      const double angle = std::atan2(norm(cross(u, v)), dot(u, v)) * 180 / std::numbers::pi;
      shape.least_angle = std::min(shape.least_angle, angle);
    }
  }
  return shape;
}

void expect_points_of(const Mesh& part, const Mesh& whole) {
  std::set<std::tuple<double, double, double>> points;
  for (const Vec3& p : whole.points) points.insert({p.x, p.y, p.z});
  for (const Vec3& p : part.points) EXPECT_TRUE(points.count({p.x, p.y, p.z}) == 1);
}

TEST(TidyMeshTest, RemovesTheNeedlesAndCapsOfABall) {
  const ImplicitFunction ball = [](const Vec3& p) { return norm(p - Vec3{0.03, 0.01, 0.02}) - 1; };
  const Mesh mesh = mesh_zero_set(ball, {.low = {-1.5, -1.5, -1.5}, .high = {1.5, 1.5, 1.5}, .spacing = 0.1});
  ASSERT_LT(shape_of(mesh).shortest_edge, 0.01);
  const Mesh tidy = tidy_mesh(mesh, 0.04);
  expect_solid_boundary(tidy);
  expect_points_of(tidy, mesh);
  EXPECT_GE(shape_of(tidy).shortest_edge, 0.04);
  EXPECT_GT(shape_of(tidy).least_angle, 12);
  EXPECT_NEAR(mesh_facts(tidy).volume, mesh_facts(mesh).volume, 0.005 * mesh_facts(mesh).volume);
}

TEST(TidyMeshTest, StopsWhenAsked) {
  const Mesh mesh = make_torus(2, 0.1, 1200);
  expect_stops_wherever_it_is_asked(3, [&](ExecutionContext* context) { tidy_mesh(mesh, 0.5, context); });
}

TEST(TidyMeshTest, KeepsTheGenusOfATorusTooThinForItsEdges) {
  const Mesh mesh = make_torus(2, 0.1, 1200);
  const Mesh tidy = tidy_mesh(mesh, 0.5);
  expect_solid_boundary(tidy, 1);
  EXPECT_LT(tidy.triangles.size(), mesh.triangles.size());
}

TEST(TidyMeshTest, LeavesATetrahedronAndEveryPieceAlone) {
  const Mesh tetrahedron = make_tetrahedron(1);
  EXPECT_EQ(tidy_mesh(tetrahedron, 2).triangles, tetrahedron.triangles);
  const Mesh two = joined(make_sphere(1, 80), moved(make_sphere(1, 80), {3, 0, 0}));
  const MeshFacts facts = mesh_facts(tidy_mesh(two, 10));
  EXPECT_EQ(facts.components, 2u);
  EXPECT_EQ(facts.euler, 4);
  EXPECT_TRUE(facts.closed && facts.oriented && facts.vertices_manifold);
}

TEST(TidyMeshTest, FlipsACap) {
  // A box whose top has a vertex almost on one of its edges' diagonal.
  Mesh mesh = make_box(1, 1, 1, 1);
  const Triangle cut = mesh.triangles[0];
  const Vec3 &a = mesh.points[cut[0]], &b = mesh.points[cut[1]], &c = mesh.points[cut[2]];
  // On the longest side but for a thousandth.
  const Vec3 sides = {norm(b - a), norm(c - b), norm(a - c)};
  const std::size_t k = sides.x > 1.1 ? 0 : sides.y > 1.1 ? 1 : 2;
  const Vec3 middle =
      0.4995 * (mesh.points[cut[k]] + mesh.points[cut[(k + 1) % 3]]) + 0.001 * mesh.points[cut[(k + 2) % 3]];
  const auto v = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.push_back(middle);
  mesh.triangles[0] = {cut[0], cut[1], v};
  mesh.triangles.push_back({cut[1], cut[2], v});
  mesh.triangles.push_back({cut[2], cut[0], v});
  ASSERT_LT(shape_of(mesh).least_angle, 1);
  const Mesh tidy = tidy_mesh(mesh, 0.01);
  expect_solid_boundary(tidy);
  EXPECT_EQ(tidy.points.size(), mesh.points.size());
  EXPECT_NEAR(mesh_facts(tidy).volume, 1, 1e-12);
  EXPECT_GT(shape_of(tidy).least_angle, 30);
}

}  // namespace
}  // namespace affskel::core

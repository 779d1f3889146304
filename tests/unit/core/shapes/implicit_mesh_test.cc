#include "core/shapes/implicit_mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/mesh_checks.h"

namespace affskel::core {
namespace {

double ball(const Vec3& p) {
  return norm(p) - 1;
}
double torus(const Vec3& p) {
  return std::hypot(std::hypot(p.x, p.y) - 2, p.z) - 0.7;
}

TEST(ZeroSetTest, OfABallIsASphere) {
  const Mesh mesh = mesh_zero_set(ball, {{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}, 0.1});
  expect_solid_boundary(mesh);
  for (const Vec3& p : mesh.points) EXPECT_NEAR(norm(p), 1, 0.01);
  EXPECT_NEAR(mesh_facts(mesh).volume / (4 * std::numbers::pi / 3), 1, 0.01);
}

TEST(ZeroSetTest, OfATorusHasGenusOne) {
  expect_solid_boundary(mesh_zero_set(torus, {{-3, -3, -1}, {3, 3, 1}, 0.15}), 1);
}

TEST(ZeroSetTest, IsManifoldWhereTheFunctionVanishesAtNodes) {
  // The octahedron |x| + |y| + |z| = 1: its zero set runs through lattice nodes, edges and faces.
  const auto octahedron = [](const Vec3& p) {
    return (std::abs(p.x) + std::abs(p.y) + std::abs(p.z) - 1) / std::sqrt(3.0);
  };
  const Mesh mesh = mesh_zero_set(octahedron, {{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}, 0.125});
  expect_solid_boundary(mesh);
  EXPECT_NEAR(mesh_facts(mesh).volume, 4.0 / 3, 0.05);
}

TEST(ZeroSetTest, IsEmptyWhereNothingIs) {
  const auto nothing = [](const Vec3&) { return 5.0; };
  EXPECT_TRUE(mesh_zero_set(nothing, {{-1, -1, -1}, {1, 1, 1}, 0.1}).triangles.empty());
}

TEST(FairOntoTest, PutsVerticesOnTheZeroSetAndEvensTriangles) {
  Mesh mesh = mesh_zero_set(torus, {{-3, -3, -1}, {3, 3, 1}, 0.15});
  const auto shortest = [&] {
    double least = 1;
    for (const Triangle& t : mesh.triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        least = std::min(least, norm(mesh.points[t[k]] - mesh.points[t[(k + 1) % 3]]));
      }
    }
    return least;
  };
  const double before = shortest();
  fair_onto(torus, 1e-5, 4, mesh);
  for (const Vec3& p : mesh.points) EXPECT_NEAR(torus(p), 0, 1e-4);
  EXPECT_GT(shortest(), 2 * before);
  expect_solid_boundary(mesh, 1);
}

}  // namespace
}  // namespace affskel::core

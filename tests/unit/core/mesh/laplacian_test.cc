#include "core/mesh/laplacian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>

#include "core/mesh/geodesic_sphere.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// A vertex of an icosahedron about the origin has five neighbours, whose mean is its fifth root of five part.
TEST(Laplacian, MovesTheVerticesOfAnIcosahedronTowardsItsCentre) {
  Mesh mesh = icosahedron();
  mesh.points.push_back({7, 8, 9});  // of no triangle
  const Mesh before = mesh;
  smooth(mesh, 1);
  const double share = 1 / std::sqrt(5.0);
  for (std::size_t v = 0; v < 12; ++v)
    EXPECT_LT(norm(mesh.points[v] - 0.5 * (1 + share) * before.points[v]), 1e-15);
  EXPECT_EQ(mesh.points[12], before.points[12]);
  EXPECT_EQ(mesh.triangles, before.triangles);
}

}  // namespace
}  // namespace affskel::core

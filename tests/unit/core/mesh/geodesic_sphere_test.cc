#include "core/mesh/geodesic_sphere.h"

#include <gtest/gtest.h>

#include "core/mesh_checks.h"

namespace affskel::core {
namespace {

TEST(GeodesicSphere, IsAClosedSphereOfUnitVectors) {
  for (const std::uint32_t f : {1U, 2U, 5U, 16U}) {
    const Mesh mesh = geodesic_sphere(f);
    EXPECT_EQ(mesh.triangles.size(), 20U * f * f);
    EXPECT_EQ(mesh.points.size(), 10U * f * f + 2);
    expect_solid_boundary(mesh);
    for (const Vec3& p : mesh.points) EXPECT_NEAR(norm(p), 1, 1e-15);
  }
}

}  // namespace
}  // namespace affskel::core

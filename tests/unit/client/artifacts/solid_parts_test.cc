#include "client/artifacts/solid_parts.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace affskel::client {
namespace {

// 200 triangles as large as each other, of thickness 0.8 to 1, but for the first ones.
v1::SolidParts triangles(const std::vector<double>& first) {
  v1::SolidParts solid;
  v1::TriangleMesh& surface = *solid.mutable_surface();
  for (const double c : {0., 0., 0., 1., 0., 0., 0., 1., 0.}) surface.add_xyz(c);
  for (std::size_t t = 0; t < 200; ++t) {
    for (const std::uint32_t v : {0U, 1U, 2U}) surface.add_corners(v);
    solid.add_thickness(t < first.size() ? first[t] : 1 - 0.001 * double(t));
  }
  return solid;
}

TEST(ThicknessScale, LeavesOutAHundredthThatIsMuchThicker) {
  const ThicknessScale two = thickness_scale(triangles({9, 22, 1}));
  EXPECT_EQ(two.highest, 1);
  EXPECT_EQ(two.greatest, 22);
  EXPECT_EQ(thickness_scale(triangles({9, 22, 8})).highest, 8) << "the third is within the rest";
}

TEST(ThicknessScale, GoesUpToTheGreatestThatIsNotMuchMore) {
  const ThicknessScale scale = thickness_scale(triangles({1.3}));
  EXPECT_EQ(scale.highest, 1.3);
  EXPECT_EQ(scale.greatest, 1.3);
  EXPECT_EQ(thickness_scale({}).highest, 0);
}

// By area, not by how many: the first is larger than all others.
TEST(ThicknessScale, WeighsTrianglesByTheirArea) {
  v1::SolidParts solid = triangles({22});
  for (const double c : {0., 0., 0., 100., 0., 0., 0., 100., 0.}) solid.mutable_surface()->add_xyz(c);
  for (int v = 0; v < 3; ++v) solid.mutable_surface()->set_corners(v, static_cast<std::uint32_t>(3 + v));
  EXPECT_EQ(thickness_scale(solid).highest, 22);
}

}  // namespace
}  // namespace affskel::client

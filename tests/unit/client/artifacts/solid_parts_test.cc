#include "client/artifacts/solid_parts.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace affskel::client {
namespace {

// 200 triangles as large as each other, of thickness 0.8 to 1, but for the first ones.
struct Surface {
  explicit Surface(const std::vector<double>& first) {
    mesh.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.triangles.resize(200, {0, 1, 2});
    for (std::size_t t = 0; t < 200; ++t)
      thickness.push_back(t < first.size() ? first[t] : 1 - 0.001 * static_cast<double>(t));
  }
  ThicknessScale scale() const { return thickness_scale(mesh, thickness); }

  core::Mesh mesh;
  std::vector<double> thickness;
};

TEST(ThicknessScale, LeavesOutAHundredthThatIsMuchThicker) {
  const ThicknessScale two = Surface({9, 22, 1}).scale();
  EXPECT_EQ(two.highest, 1);
  EXPECT_EQ(two.greatest, 22);
  EXPECT_EQ(Surface({9, 22, 8}).scale().highest, 8) << "the third is within the rest";
}

TEST(ThicknessScale, GoesUpToTheGreatestThatIsNotMuchMore) {
  const ThicknessScale scale = Surface({1.3}).scale();
  EXPECT_EQ(scale.highest, 1.3);
  EXPECT_EQ(scale.greatest, 1.3);
  EXPECT_EQ(thickness_scale({}, {}).highest, 0);
}

// By area, not by how many: the first is larger than all others.
TEST(ThicknessScale, WeighsTrianglesByTheirArea) {
  Surface surface({22});
  surface.mesh.points.insert(surface.mesh.points.end(), {{0, 0, 0}, {100, 0, 0}, {0, 100, 0}});
  surface.mesh.triangles[0] = {3, 4, 5};
  EXPECT_EQ(surface.scale().highest, 22);
}

}  // namespace
}  // namespace affskel::client

#include "core/erosion/height_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/erosion/directions.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"

namespace affskel::core {
namespace {

// All sorts (comparison; two and three digits of 8 bits, three of 11) must give the order of the heights.
TEST(HeightOrder, SortsByHeight) {
  for (std::uint32_t triangles : {20U, 320U, 1280U, 20480U}) {
    const Solid solid = make_solid(make_sphere(1, triangles));
    const std::vector<Vec3>& points = solid.mesh.points;
    HeightOrder heights(points);
    for (const Vec3& d : make_directions(solid, "random:20:3")) {
      heights.sort(d);
      std::vector<bool> seen(points.size());
      for (std::size_t r = 0; r < points.size(); ++r) {
        const std::uint32_t v = heights.order()[r];
        ASSERT_FALSE(seen[v]);
        seen[v] = true;
        ASSERT_NEAR(heights.height()[r], dot(d, points[v]), 1e-13);
        if (r > 0) {
          ASSERT_LE(heights.height()[r - 1], heights.height()[r]);
        }
      }
    }
  }
}

TEST(HeightOrder, VerticesOfALevelFaceTieWhateverTheRounding) {
  const Solid solid = make_solid(make_box(3, 2, 1, 20));
  for (const Vec3& d : make_directions(solid, "triangles")) {
    HeightOrder heights(solid.mesh.points);
    heights.sort(d);
    // The bottom face of the box for this direction: 21 x 21 vertices.
    EXPECT_EQ(heights.height()[0], heights.height()[440]);
    EXPECT_LT(heights.height()[440], heights.height()[441]);
  }
}

}  // namespace
}  // namespace affskel::core

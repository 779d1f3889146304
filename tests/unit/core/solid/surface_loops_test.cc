#include "core/solid/surface_loops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/shapes/shapes.h"
#include "core/solid/betti_numbers.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

std::vector<Vec3> circle(double radius, const Vec3& centre, bool upright = false) {
  std::vector<Vec3> result;
  for (int n = 0; n < 40; ++n) {
    const double a = 2 * std::numbers::pi * n / 40, c = radius * std::cos(a), s = radius * std::sin(a);
    result.push_back(centre + (upright ? Vec3{c, 0, s} : Vec3{c, s, 0}));
  }
  return result;
}

bool is_linked_with_any(const std::vector<Vec3>& line, const Mesh& mesh) {
  const auto loops = surface_loops(mesh);
  return std::any_of(loops.begin(), loops.end(), [&](const auto& loop) {
    std::vector<Vec3> places;
    for (const std::uint32_t v : loop) places.push_back(mesh.points[v]);
    return is_linked(line, places);
  });
}

TEST(SurfaceLoops, AreTwoForEachHandle) {
  EXPECT_TRUE(surface_loops(make_sphere(1, 320)).empty());
  EXPECT_EQ(surface_loops(make_torus(3, 1, 256)).size(), 2U);
  EXPECT_EQ(surface_loops(joined(make_torus(3, 1, 256), moved(make_torus(3, 1, 64), {9, 0, 0}))).size(), 4U);
}

TEST(SurfaceLoops, AreLinkedWithWhatGoesRoundAHandle) {
  const Mesh torus = make_torus(3, 1, 256);
  EXPECT_TRUE(is_linked_with_any(circle(3, {0, 0, 0}), torus));
  EXPECT_FALSE(is_linked_with_any(circle(0.5, {3, 0, 0}), torus));
  EXPECT_FALSE(is_linked_with_any(circle(0.5, {3, 0, 0}, true), torus));
}

TEST(IsLinked, TellsHopfsLinkFromTwoCirclesBesideEachOther) {
  const auto flat = circle(1, {0, 0, 0});
  EXPECT_TRUE(is_linked(flat, circle(1, {1, 0, 0}, true)));
  EXPECT_TRUE(is_linked(circle(1, {1, 0, 0}, true), flat));
  EXPECT_FALSE(is_linked(flat, circle(1, {3, 0, 0}, true)));
  EXPECT_FALSE(is_linked(flat, circle(0.5, {0, 0, 0.1})));
}

// Places above each other, and lines that are seen as one.
TEST(IsLinked, TellsWhatIsSeenInOnePlace) {
  const std::vector<Vec3> ring{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
  const std::vector<Vec3> through{{0, 0, -1}, {0, 0, 0}, {0, 0, 1}, {2, 0, 1}, {2, 0, -1}};
  const std::vector<Vec3> above{{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  EXPECT_TRUE(is_linked(ring, through));
  EXPECT_TRUE(is_linked(through, ring));
  EXPECT_FALSE(is_linked(ring, above));
  EXPECT_FALSE(is_linked(above, ring));
}

}  // namespace
}  // namespace affskel::core

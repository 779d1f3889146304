#include "core/curve/centre_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/curve/tubes.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

// A zigzag of legs a few segments long, which averages of neighbours cut short.
TEST(CentreLines, NoVertexLeavesAZigzag) {
  constexpr double kRadius = 0.08, kSpacing = 0.1;
  std::vector<Vec3> corners;
  for (int n = 0; n < 8; ++n) corners.push_back({0.3 * n, n % 2 == 0 ? 0. : 0.4, 0});
  std::vector<Tube> tubes;
  for (std::size_t n = 1; n < corners.size(); ++n) tubes.push_back({corners[n - 1], corners[n], kRadius});
  const Mesh mesh = tube_mesh(tubes, 0.04);
  std::vector<Vec3> places;
  std::vector<Segment> segments;
  for (const Tube& tube : tubes) {
    const double length = norm(tube.to - tube.from);
    for (double way = 0; way < length; way += kSpacing)
      places.push_back(tube.from + (way / length) * (tube.to - tube.from) + Vec3{0, 0, 0.7 * kRadius});
  }
  for (std::uint32_t v = 1; v < places.size(); ++v) segments.push_back({v - 1, v});
  const std::vector<Vec3> before = places, tip(places.size());
  const std::vector<char> has_tip(places.size(), 0);
  centre_lines({.surface = mesh, .segments = segments, .tip = tip, .has_tip = has_tip, .spacing = kSpacing},
               places);
  const SolidMembership solid(mesh);
  double farthest = 0;
  for (std::size_t v = 0; v < places.size(); ++v) {
    ASSERT_TRUE(solid.contains(before[v]));
    EXPECT_TRUE(solid.contains(places[v])) << v;
    farthest = std::max(farthest, norm(places[v] - before[v]));
  }
  EXPECT_GT(farthest, 0.5 * kRadius) << "they go to the middle";
}

}  // namespace
}  // namespace affskel::core

#include "core/ridge/local_thickness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "core/base/none.h"
#include "core/lattice/lattice.h"
#include "core/ridge/local_depth.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/stopping_context.h"

namespace affskel::core {
namespace {

struct Sampled {
  explicit Sampled(const Mesh& mesh, double spacing) {
    const Solid solid = make_solid(mesh);
    LatticeOptions options;
    options.spacing = spacing;
    lattice = make_lattice(solid, options);
    distance = surface_distance(lattice);
    points.resize(lattice.points);
    std::iota(points.begin(), points.end(), 0U);
  }

  std::vector<float> thickness(const LocalThicknessOptions& options = {}) const {
    return local_thickness(DualComplex(lattice), distance, points, options);
  }

  Lattice lattice;
  std::vector<float> distance;
  std::vector<std::uint32_t> points;
};

// Half of a plate's, up to its edges; at its corners, which are farther from the middle, not much less.
TEST(LocalThickness, OfAPlateIsHalfOfItUpToItsEdges) {
  const Sampled plate(make_box(40.2, 40.2, 10.2), 1);
  const std::vector<float> found = plate.thickness();
  const float most = *std::max_element(found.begin(), found.end());
  EXPECT_NEAR(most, 5.1F, 0.6F);
  std::size_t less = 0;
  for (const float thickness : found) {
    EXPECT_GE(thickness, 0.6F * most);
    less += thickness < most;
  }
  EXPECT_LT(less, found.size() / 20);
}

// Whichever way it is turned, from its surface, too.
TEST(LocalThickness, OfATubeIsItsRadius) {
  for (const Vec3& turned : {Vec3{1, 0, 0}, Vec3{1, 1, 0}, Vec3{1, 1, 1}}) {
    const double angle = turned.y == 0 ? 0 : turned.z == 0 ? 0.785 : 0.955;
    Mesh mesh = make_cylinder(6, 60, 64);
    for (Vec3& p : mesh.points)
      p = {std::cos(angle) * p.x - std::sin(angle) * p.z, p.y, std::sin(angle) * p.x + std::cos(angle) * p.z};
    const std::vector<float> found = Sampled(mesh, 1).thickness();
    const auto off = std::count_if(found.begin(), found.end(),
                                   [](float thickness) { return std::abs(thickness - 6) > 1.3F; });
    EXPECT_LE(off, 4) << angle << ": on the edges of its ends";
  }
}

TEST(LocalThickness, IsInfiniteWithoutAPointDoesNotDependOnThreadsAndStops) {
  Sampled ball(make_sphere(8, 320), 1);
  ball.points.front() = kNone;
  const std::vector<float> one = ball.thickness();
  EXPECT_EQ(one.front(), std::numeric_limits<float>::infinity());
  EXPECT_EQ(ball.thickness({.threads = 3}), one);
  expect_stops_wherever_it_is_asked(
      1, [&](ExecutionContext* context) { (void)ball.thickness({.context = context}); });
}

}  // namespace
}  // namespace affskel::core

#include "core/quality/chance_level.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

constexpr double kPi = 3.14159265358979323846;

// A cube of 10 x 10 x 10 sample points at spacing 0.5.
struct Cube {
  Solid solid = make_solid(make_box(5, 5, 5));
  Lattice lattice;
  SolidMembership membership{solid.mesh};
  Cube() {
    LatticeOptions options;
    options.spacing = 0.5;
    lattice = make_lattice(solid, options);
  }
};

TEST(ChanceLevel, OfOnePointIsItsBallsShareOfTheVolume) {
  const Cube cube;
  ChanceLevelOptions options;
  options.draws = 200000;
  for (const double radius : {std::sqrt(0.75), 2.0}) {  // in spacings
    options.radius = radius;
    const double share = 4 * kPi / 3 * radius * radius * radius / 1000;
    const double error = std::sqrt(share * (1 - share) / options.draws);
    EXPECT_NEAR(chance_level(cube.lattice, cube.membership, std::vector<Vec3>{{2, 2, 2}}, options), share,
                4 * error);
  }
}

TEST(ChanceLevel, IsOneWhenEveryPointIsKept) {
  const Cube cube;
  std::vector<Vec3> all;
  for (int i = 0; i < 10; ++i) {
    for (int j = 0; j < 10; ++j) {
      for (int k = 0; k < 10; ++k) all.push_back({0.5 * i, 0.5 * j, 0.5 * k});
    }
  }
  EXPECT_EQ(chance_level(cube.lattice, cube.membership, all), 1);
}

// Frames only turn and stretch: what counts are distances in the frame's coordinates.
TEST(ChanceLevel, MeasuresInTheFrame) {
  const Cube cube;
  LatticeGrid grid = cube.lattice.grid;  // stretched by 2 along x, squeezed by 2 along z
  grid.axes[0] = 2 * grid.axes[0];
  grid.axes[2] = 0.5 * grid.axes[2];
  grid.origin = grid.origin + 0.25 * grid.axes[0] + (-0.5) * grid.axes[2];
  grid.dims = {5, 10, 20};
  const Lattice stretched = make_lattice(cube.solid, grid);
  ASSERT_EQ(stretched.points, 1000U);
  ChanceLevelOptions options;
  options.draws = 200000;
  const double share = 4 * kPi / 3 * 0.75 * std::sqrt(0.75) / 1000;
  EXPECT_NEAR(chance_level(stretched, cube.membership, std::vector<Vec3>{{1, 2, 5}}, options), share,
              4 * std::sqrt(share / options.draws));
}

}  // namespace
}  // namespace affskel::core

#include "core/collapse/sheet_fronts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/collapse/collapsing.h"
#include "core/collapse/lattice_solids.h"
#include "core/ridge/local_depth.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

using Cell = DualComplex::Cell;

// A thinning that asks for nothing but the last time at which anything of a sheet is reached.
struct Times {
  const DualComplex& complex;
  const std::vector<float>& depth;
  SheetFronts fronts{complex, depth};
  double last = 0, steps = 0;

  Collapsing::Due due(Cell cell, Cell coface, double now) {
    if (DualComplex::dimension(coface) == 2) fronts.stands_at(cell);
    const bool passed = DualComplex::dimension(coface) < 3 && fronts.is_passed(cell, coface);
    const auto depth_there = static_cast<double>(depth[DualComplex::cube_of(coface)]);
    return {DualComplex::dimension(coface) == 3 ? std::max(now, depth_there) : now + (passed ? 0 : 1),
            passed};
  }
  double level(Cell cell) const { return radius_about(complex, depth, cell); }
  void removed(Cell cell, Cell coface, double now, bool passed) {
    if (DualComplex::dimension(coface) != 2) return;
    last = std::max(last, static_cast<double>(fronts.cross(cell, coface, passed)));
    steps = std::max(steps, now);
  }
  void wave_ends() { fronts.end_wave(); }
};

// The fronts from the rim of a plate's middle meet in the middle, half the plate's width from its sides.
TEST(SheetFronts, CrossAPlateAtUnitSpeedHoweverItLies) {
  double slowest = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const double spacing = 0.2;
    const LatticeSolid solid(shaken(make_cylinder(5, 1.6, 64), 0, seed), spacing);
    const DualComplex complex(solid.lattice);
    const std::vector<float> depth = surface_distance(solid.lattice);
    Times times{complex, depth};
    Collapsing(complex, nullptr).run(times);
    EXPECT_NEAR(times.last, 5 / spacing, 0.2 * 5 / spacing) << seed;
    slowest = std::max(slowest, times.steps);
  }
  EXPECT_GT(slowest, 1.3 * 25) << "counted in steps of the lattice";
}

}  // namespace
}  // namespace affskel::core

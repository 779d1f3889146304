#include "core/collapse/shortest_ways.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/collapse/lattice_solids.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// In a convex solid no way is shorter than straight steps along the three kinds of diagonals.
TEST(ShortestWays, GoAlongDiagonals) {
  const LatticeSolid box(make_box(6, 6, 6), 1);
  const DualComplex complex(box.lattice);
  const Anchor corner{DualComplex::name(0, 0), 0};  // the lowest corner of the first cube
  const std::vector<float> way = shortest_ways(complex, {&corner, 1}, {});
  const std::uint32_t last = complex.cubes() - 1;
  const auto steps = static_cast<float>(std::round(std::cbrt(static_cast<double>(complex.cubes()))) - 1);
  EXPECT_EQ(way[0], 0);
  EXPECT_NEAR(way[last], steps * std::sqrt(3.0F), 1e-4);
}

TEST(ShortestWays, LeadToEndsWhereThereIsNothingElse) {
  const LatticeSolid box(make_box(6, 6, 6), 1);
  const DualComplex complex(box.lattice);
  const std::uint32_t last = complex.cubes() - 1;
  const std::vector<Anchor> anchors{{DualComplex::name(0, 0), 0},
                                    {complex.cell(last, DualComplex::kUpperVertex), 0, true}};
  EXPECT_GT(shortest_ways(complex, anchors, {})[last], 1);
  EXPECT_EQ(shortest_ways(complex, {&anchors[1], 1}, {})[last], 0);
}

TEST(ShortestWays, TellWhatIsNear) {
  std::size_t near = 0, far = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.2);
    const DualComplex complex(solid.lattice);
    SplitMix64 random(seed);
    std::vector<float> reach(complex.cubes(), -1);
    for (int n = 0; n < 3; ++n) reach[random.next() % reach.size()] = n == 0 ? 3 : kNoWay;
    const Anchor from{complex.cell(static_cast<std::uint32_t>(random.next() % complex.cubes()), 26), 0};
    const std::vector<float> way = shortest_ways(complex, {&from, 1}, {});
    const auto wanted = [&](std::uint32_t cube, float length) { return length <= reach[cube]; };
    float nearest = kNoWay;
    for (std::size_t cube = 0; cube < way.size(); ++cube)
      if (way[cube] <= reach[cube]) nearest = std::min(nearest, way[cube]);
    for (const float longest : {0.5F, 2.0F, 4.0F, 8.0F}) {
      if (std::abs(nearest - longest) < 0.2F) continue;  // ways are told apart to a share of a spacing
      EXPECT_EQ(is_near(complex, from.cell, longest, wanted), nearest < longest) << seed;
      ++(nearest < longest ? near : far);
    }
  }
  EXPECT_GT(near, 20U);
  EXPECT_GT(far, 20U);
}

}  // namespace
}  // namespace affskel::core

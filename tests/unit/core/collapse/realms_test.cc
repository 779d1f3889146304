#include "core/collapse/realms.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/base/split_mix64.h"
#include "core/collapse/lattice_solids.h"
#include "core/collapse/shortest_ways.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// On a line of cubes the border lies in the middle between the balls.
TEST(Realms, PartAWayBetweenTheBalls) {
  const LatticeSolid rod(make_box(101, 1, 1), 1);
  const DualComplex complex(rod.lattice);
  const auto last = complex.cubes() - 1;
  const std::array<RealmSeed, 2> seeds{RealmSeed{0, 21}, RealmSeed{last, 1}};
  std::array<double, 2> size{};
  for (const std::uint32_t seed : realms(complex, seeds)) ++size.at(seed);
  EXPECT_NEAR(size[0] - size[1], 20, 1);
}

// A seed within another's ball has nothing.
TEST(Realms, OfASeedInALargerBallAreEmpty) {
  const LatticeSolid rod(make_box(51, 1, 1), 1);
  const DualComplex complex(rod.lattice);
  const std::array<RealmSeed, 2> seeds{RealmSeed{10, 2}, RealmSeed{14, 9}};
  for (const std::uint32_t seed : realms(complex, seeds)) EXPECT_EQ(seed, 1U);
}

// With equal radii the nearest seed has a cube; realms hang together.
TEST(Realms, BelongToTheNearestSeed) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.2);
    const DualComplex complex(solid.lattice);
    SplitMix64 random(seed);
    std::vector<RealmSeed> seeds;
    std::vector<std::vector<float>> ways;
    for (int n = 0; n < 3; ++n) {
      seeds.push_back({static_cast<std::uint32_t>(random.next() % complex.cubes()), 2});
      const Anchor middle{DualComplex::name(seeds.back().cube, DualComplex::kCube), 0};
      ways.push_back(shortest_ways(complex, {&middle, 1}, {}));
    }
    const std::vector<std::uint32_t> realm = realms(complex, seeds);
    DisjointSets together(complex.cubes());
    for (std::uint32_t cube = 0; cube < complex.cubes(); ++cube) {
      float nearest = kNoWay;
      for (const auto& way : ways) nearest = std::min(nearest, way[cube]);
      if (nearest == kNoWay) {
        EXPECT_EQ(realm[cube], kNone);
        continue;
      }
      ASSERT_LT(realm[cube], seeds.size());
      EXPECT_EQ(ways[realm[cube]][cube], nearest) << seed;
      complex.for_each_step(cube, [&](std::uint32_t to, std::uint32_t) {
        if (realm[to] == realm[cube]) together.unite(cube, to);
      });
    }
    for (std::uint32_t cube = 0; cube < complex.cubes(); ++cube) {
      if (realm[cube] == kNone) continue;
      EXPECT_EQ(together.find(cube), together.find(seeds[realm[cube]].cube)) << seed;
    }
  }
}

}  // namespace
}  // namespace affskel::core

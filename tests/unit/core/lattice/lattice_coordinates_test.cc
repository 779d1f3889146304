#include "core/lattice/lattice_coordinates.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/test_solids.h"

namespace affskel::core {
namespace {

TEST(LatticePlaces, AreWhereTheWalkOverAllPointsFindsThem) {
  const Solid solid = make_solid(hollow_ball());
  LatticeOptions options;
  options.spacing = 0.4;
  const Lattice lattice = make_lattice(solid, options);
  std::vector<std::uint32_t> some;
  std::vector<LatticePlace> expected;
  for (const LatticeRun& run : lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      if ((run.first + n) % 7 > 1) continue;
      some.push_back(run.first + n);
      expected.push_back({run.start[0], run.start[1], run.start[2] + n});
    }
  }
  EXPECT_EQ(lattice_places(lattice, some), expected);
  std::reverse(some.begin(), some.end());
  std::reverse(expected.begin(), expected.end());
  EXPECT_EQ(lattice_places(lattice, some), expected);
  EXPECT_TRUE(lattice_places(lattice, {}).empty());
}

TEST(SamplePoints, AreThoseOfTheWalkOverAllPoints) {
  LatticeOptions options;
  options.spacing = 0.4;
  const Lattice lattice = make_lattice(make_solid(hollow_ball()), options);
  std::set<LatticePlace> all;
  LatticePlace last{};
  for (const LatticeRun& run : lattice.axis[2].runs)
    for (std::uint32_t n = 0; n < run.length; ++n) {
      const LatticePlace place{run.start[0], run.start[1], run.start[2] + n};
      all.insert(place);
      for (std::size_t k = 0; k < 3; ++k) last[k] = std::max(last[k], place[k]);
    }
  for (int i = -1; i <= int(last[0]) + 1; ++i)
    for (int j = -1; j <= int(last[1]) + 1; ++j)
      for (int k = -1; k <= int(last[2]) + 1; ++k) {
        const LatticePlace place{std::uint32_t(i), std::uint32_t(j), std::uint32_t(k)};
        ASSERT_EQ(is_sample_point(lattice, {i + 0.4, j - 0.4, k + 0.3}), all.count(place) > 0)
            << i << ' ' << j << ' ' << k;
      }
}

TEST(ScaledPlace, IsThePlaceOfTheSamplePoint) {
  const Solid solid = make_solid(hollow_ball());
  LatticeOptions options;
  options.spacing = 0.4;
  const Lattice lattice = make_lattice(solid, options);
  const Vec3 expected = SamplePlaces(solid, lattice).at(3, 4, 5);
  const Vec3 found = solid.centre + solid.scale() * scaled_place(lattice, {3, 4, 5});
  EXPECT_NEAR(norm(found - expected), 0, 1e-14);
  EXPECT_EQ(scaled_from_frame(lattice, lattice.spacing * Vec3{3, 4, 5}), scaled_place(lattice, {3, 4, 5}));
  EXPECT_NEAR(norm(LatticeIndices(lattice)(scaled_place(lattice, {3, 4, 5})) - Vec3{3, 4, 5}), 0, 1e-12);
}

}  // namespace
}  // namespace affskel::core

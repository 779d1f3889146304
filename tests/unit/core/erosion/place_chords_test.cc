#include "core/erosion/place_chords.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "core/erosion/computed.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

Vec3 scaled(const Solid& solid, const Vec3& x) {
  return (1 / solid.scale()) * (x - solid.centre);
}

// The sweep finds the same chords another way: from the ends of a lattice's runs.
void expect_as_the_sweep(const Mesh& mesh, double spacing) {
  int compared = 0;
  for (int seed = 1; seed <= 8; ++seed) {
    const Computed swept = compute(mesh, spacing, "random:1:" + std::to_string(seed));
    std::vector<Vec3> places;
    for (const Vec3& x : swept.place) places.push_back(scaled(swept.solid, x));
    const PlaceChords chords(swept.solid, places);
    const TreeInput input(swept.solid);
    JoinTreeBuilder builder(input, {swept.solid.self_intersecting});
    const Vec3& d = swept.directions[0];
    std::vector<float> found(places.size() / 2);
    chords.along(builder.build(d), d, places.size() / 4, 2 * input.volume_tolerance(), found);
    for (std::size_t i = 0; i < found.size(); ++i) {
      const std::size_t p = places.size() / 4 + i;
      const double chord = std::ldexp(static_cast<double>(found[i]), 3 * swept.solid.exponent);
      EXPECT_TRUE(chords.inside(p));
      EXPECT_NEAR(chord, swept.value[p].erosion, 2e-7 * swept.value[p].erosion + 1e-9 * swept.solid.volume);
      ++compared;
    }
  }
  EXPECT_GT(compared, 400);
}

TEST(PlaceChords, AreThoseOfTheSweep) {
  expect_as_the_sweep(make_torus(3, 1, 256), 0.4);
  expect_as_the_sweep(cup(24), 0.3);
  expect_as_the_sweep(hollow_ball(), 0.6);
  expect_as_the_sweep(comb(4), 0.31);
  expect_as_the_sweep(joined(make_box(2, 1, 1), moved(make_box(1, 1, 1), {0.3, 0.2, 1.5})), 0.2);
}

TEST(PlaceChords, AreThoseOfTheSweepWhereTheSurfaceCrossesItself) {
  expect_as_the_sweep(overlapping_boxes(6, 5, 9), 0.7);
}

TEST(PlaceChords, AreNoneOutside) {
  const Solid solid = make_solid(hollow_ball());
  std::vector<Vec3> places;
  for (const Vec3& x : {Vec3{2, 0, 0}, {0.5, 0.1, 0}, {4, 0, 0}, {0, 0, -2.5}})
    places.push_back(scaled(solid, x));
  const PlaceChords chords(solid, places);
  const TreeInput input(solid);
  JoinTreeBuilder builder(input);
  std::vector<float> found(4, 7);
  chords.along(builder.build({0, 0, 1}), {0, 0, 1}, 0, 0, found);
  EXPECT_TRUE(chords.inside(0));
  EXPECT_FALSE(chords.inside(1)) << "in the cavity";
  EXPECT_FALSE(chords.inside(2));
  EXPECT_TRUE(chords.inside(3));
  EXPECT_GT(found[0], 0);
  EXPECT_EQ(found[1], 0);
  EXPECT_EQ(found[2], 0);
}

}  // namespace
}  // namespace affskel::core

#include "core/lattice/solid_parts.h"

#include <gtest/gtest.h>

#include "core/lattice/lattice_coordinates.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid_membership.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

struct Laid {
  Solid solid;
  Lattice lattice;
  SolidParts parts;

  Laid(const Mesh& mesh, double spacing)
      : solid(make_solid(mesh)), lattice(lattice_of(solid, spacing)), parts(solid, lattice) {}

  static Lattice lattice_of(const Solid& solid, double spacing) {
    LatticeOptions options;
    options.spacing = spacing;
    return make_lattice(solid, options);
  }
};

// Against the winding number of each part's own surface.
void expect_points_in_their_parts(const Laid& laid) {
  const std::vector<Mesh> meshes = laid.parts.meshes();
  ASSERT_EQ(meshes.size(), laid.parts.count());
  std::vector<std::uint32_t> all(laid.lattice.points);
  for (std::uint32_t p = 0; p < all.size(); ++p) all[p] = p;
  const std::vector<LatticePlace> places = lattice_places(laid.lattice, all);
  for (std::uint32_t part = 0; part < laid.parts.count(); ++part) {
    const SolidMembership membership(meshes[part]);
    std::uint32_t points = 0;
    for (const std::uint32_t p : all) {
      const auto [i, j, k] = places[p];
      const Vec3 at{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
      const bool inside = membership.contains(scaled_place(laid.lattice, at));
      EXPECT_EQ(laid.parts.of_point(p) == part, inside) << p;
      points += inside ? 1 : 0;
    }
    EXPECT_EQ(laid.parts.points(part), points);
  }
}

TEST(SolidParts, ASolidWithACavityIsOne) {
  const Laid laid(hollow_ball(), 0.3);
  EXPECT_EQ(laid.parts.count(), 1U);
  EXPECT_EQ(laid.parts.points(0), laid.lattice.points);
  expect_points_in_their_parts(laid);
}

TEST(SolidParts, ABallInACavityAndABoxBesideAreThree) {
  const Mesh kernel = moved(make_sphere(0.8, 80), {0.5, 0, 0});
  const Laid laid(joined(joined(hollow_ball(), kernel), moved(make_box(2, 2, 2), {3.1, -1, -1})), 0.3);
  EXPECT_EQ(laid.parts.count(), 3U);
  expect_points_in_their_parts(laid);
}

TEST(SolidParts, WhatPassesThroughEachOtherIsOne) {
  const Mesh far = moved(make_box(1, 1, 1), {9, 0, 0});
  const Laid laid(joined(joined(make_box(3, 3, 3), far), moved(make_box(3, 3, 3), {2, 1, 1})), 0.25);
  ASSERT_EQ(laid.solid.solid_volume.size(), 3U);
  EXPECT_EQ(laid.parts.count(), 2U);
  expect_points_in_their_parts(laid);
}

TEST(SolidParts, WhatOnlyTouchesIsNot) {
  const Laid laid(joined(make_box(3, 3, 3), moved(make_box(3, 2, 1), {3, 0.5, 0.5})), 0.25);
  EXPECT_EQ(laid.parts.count(), 2U);
  expect_points_in_their_parts(laid);
}

}  // namespace
}  // namespace affskel::core

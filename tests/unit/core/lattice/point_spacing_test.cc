#include "core/lattice/point_spacing.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/plain_math.h"
#include "core/mesh/map_mesh.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/stopping_context.h"

namespace affskel::core {
namespace {

Lattice lattice_for(const Solid& solid, std::uint64_t target, unsigned threads = 1) {
  LatticeOptions options;
  options.target_points = target;
  options.threads = threads;
  return make_lattice(solid, options);
}

// Both at once; `b` is moved by `shift`.
Mesh side_by_side(const Mesh& a, Mesh b, const Vec3& shift) {
  Mesh both = a;
  const auto first = static_cast<std::uint32_t>(a.points.size());
  for (const Vec3& p : b.points) both.points.push_back(p + shift);
  for (const Triangle& t : b.triangles) both.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return both;
}

// A ball's skin.
Mesh shell(double outer, double inner) {
  Mesh hole = make_sphere(inner, 320);
  for (Triangle& t : hole.triangles) std::swap(t[1], t[2]);
  return side_by_side(make_sphere(outer, 320), hole, {});
}

TEST(SpacingForPoints, IsTheCubeRootWhereThatIsNear) {
  for (const Mesh& mesh : {make_torus(6000, 2500, 256), make_sphere(3000, 1280), make_body({500, 18000})}) {
    const Solid solid = make_solid(mesh);
    for (const std::uint64_t target : {20000u, 50001u}) {
      const Lattice lattice = lattice_for(solid, target);
      EXPECT_EQ(lattice.spacing, cube_root(solid.volume / static_cast<double>(target)));
      EXPECT_TRUE(is_near(lattice.points, target)) << lattice.points;
    }
  }
}

TEST(SpacingForPoints, PlatesThinnerThanTheSpacingGetTheirPoints) {
  const Solid plate = make_solid(make_box(100, 100, 1));
  // One layer up to 10,000 points.
  for (const std::uint64_t target : {60u, 300u, 1000u, 3000u, 9000u, 25000u, 200000u}) {
    EXPECT_TRUE(is_near(lattice_for(plate, target).points, target)) << target;
  }
  const Solid needle = make_solid(make_box(1000, 1, 1));
  for (const std::uint64_t target : {30u, 100u, 900u, 10000u}) {
    EXPECT_TRUE(is_near(lattice_for(needle, target).points, target)) << target;
  }
}

TEST(SpacingForPoints, ObliquePlatesAndSkinsGetTheirPoints) {
  const AffineMap tilt = rotation(0, 33);
  const Solid oblique = make_solid(map_mesh(tilt, make_box(100, 80, 0.5)));
  const Solid skin = make_solid(shell(10, 9.99));
  // A layer in the middle, where neither is.
  const Solid two = make_solid(side_by_side(make_box(100, 100, 1), make_box(100, 100, 1), {0, 0, 300}));
  for (const Solid* solid : {&oblique, &skin, &two}) {
    for (const std::uint64_t target : {500u, 5000u}) {
      const Lattice lattice = lattice_for(*solid, target);
      EXPECT_TRUE(is_near(lattice.points, target)) << target << ": " << lattice.points;
    }
  }
}

// The cube root of the volume would give 46,000 points per side, all in one layer.
TEST(SpacingForPoints, FoilsGetASingleLayerAtOnce) {
  const Solid foil = make_solid(make_box(1000, 1000, 0.001));
  EXPECT_TRUE(is_foil(foil, cube_root(foil.volume / 1e5)));
  const Lattice lattice = lattice_for(foil, 100000);
  EXPECT_TRUE(is_near(lattice.points, 100000)) << lattice.points;
  EXPECT_EQ(lattice.grid.dims[2], 1U);
  EXPECT_FALSE(is_foil(make_solid(make_body({500, 18000})), 200));
}

TEST(SpacingForPoints, TakesTheNearestWhereLayersJump) {
  // 10,000 points in one layer, twice as many in two, nothing between.
  const Solid plate = make_solid(make_box(100, 100, 1));
  EXPECT_NEAR(lattice_for(plate, 13000).points, 10100, 110);
  EXPECT_NEAR(lattice_for(plate, 16000).points, 20000, 500);
}

TEST(SpacingForPoints, DoesNotDependOnTheThreads) {
  const Solid plate = make_solid(map_mesh(rotation(1, 20), make_box(100, 100, 1)));
  const Lattice one = lattice_for(plate, 4000, 1), three = lattice_for(plate, 4000, 3);
  EXPECT_EQ(one.spacing, three.spacing);
  EXPECT_EQ(one.points, three.points);
}

TEST(SpacingForPoints, CountsAsTheLatticeDoes) {
  const Solid solid = make_solid(make_torus(6000, 2500, 256));
  LatticeOptions options;
  for (const double spacing : {100.0, 333.3, 900.0}) {
    options.spacing = spacing;
    EXPECT_EQ(lattice_points(solid, options), make_lattice(solid, options).points);
  }
  options.max_points = 10;
  EXPECT_EQ(lattice_points(solid, options), std::nullopt);
  options.target_points = 100000;
  options.spacing = 0;
  EXPECT_THROW(make_lattice(solid, options), CoreError) << "10 points are not near 100000";
}

// A plate half a spacing thick takes several lattices, each of which asks three times at least.
TEST(SpacingForPoints, StopsBetweenAndWithinItsLattices) {
  const Solid solid = make_solid(make_box(100, 100, 0.5));
  LatticeOptions options;
  options.target_points = 5000;
  expect_stops_wherever_it_is_asked(7, [&](ExecutionContext* context) {
    options.context = context;
    spacing_for_points(solid, options, 1);
  });
}

}  // namespace
}  // namespace affskel::core

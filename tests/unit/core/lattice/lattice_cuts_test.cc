#include "core/lattice/lattice_cuts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/base/none.h"
#include "core/lattice/layer_index.h"
#include "core/shapes/shapes.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

using Indices = std::array<std::int64_t, 3>;

Lattice lattice_at(const Solid& solid, double spacing) {
  LatticeOptions options;
  options.spacing = spacing;
  return make_lattice(solid, options);
}

// Visits every edge with both ends' ranks.
void for_each_edge(const Lattice& lattice,
                   const std::function<void(const Indices&, const Indices&, unsigned, bool, bool)>& visit) {
  const auto dims = lattice.grid.dims;
  LayerIndex ranks(lattice);
  for (std::int64_t i = -1; i < dims[0]; ++i) {
    if (i + 1 < dims[0]) ranks.move_to(static_cast<std::uint32_t>(i + 1));
    for (std::int64_t j = -1; j < dims[1]; ++j) {
      for (std::int64_t k = -1; k < dims[2]; ++k) {
        for (unsigned step = 1; step < 8; ++step) {
          const Indices from{i, j, k}, to{i + ((step >> 2) & 1), j + ((step >> 1) & 1), k + (step & 1)};
          const auto inside = [&](const Indices& p) { return ranks.at(p[0], p[1], p[2]) != kNone; };
          visit(from, to, step, inside(from), inside(to));
        }
      }
    }
  }
}

Vec3 at(const SamplePlaces& places, const Indices& from, const Indices& to, double share) {
  Vec3 x = places.origin();
  for (std::size_t a = 0; a < 3; ++a) {
    x = x + (static_cast<double>(from[a]) + share * static_cast<double>(to[a] - from[a])) * places.axes()[a];
  }
  return x;
}

TEST(LatticeCutsTest, MeetABallsSurfaceOnEveryEdgeThatLeavesIt) {
  // No place of the lattice lies on the surface; sagitta of 20480 triangles: 0.0013.
  const Solid solid = make_solid(make_sphere(1, 20000));
  const Lattice lattice = lattice_at(solid, 0.19);
  const LatticeCuts cuts(solid, lattice);
  const SamplePlaces places(solid, lattice);
  std::size_t crossed = 0;
  for_each_edge(lattice, [&](const Indices& from, const Indices& to, unsigned step, bool in, bool out) {
    const LatticeCut* cut = cuts.find(cuts.edge(from[0], from[1], from[2], step));
    if (in && out) {
      EXPECT_EQ(cut, nullptr);
    }
    if (in == out) return;
    ASSERT_NE(cut, nullptr);
    EXPECT_FALSE(cut->gap);
    const double share = in ? cut->leaves : cut->enters;
    EXPECT_EQ(in ? cut->enters : cut->leaves, in ? 1 : 0);
    EXPECT_NEAR(norm(at(places, from, to, share)), 1, 0.0015);
    ++crossed;
  });
  EXPECT_GT(crossed, 1000u);
}

TEST(LatticeCutsTest, StopWhenAsked) {
  const Solid solid = make_solid(make_sphere(1, 20000));
  const Lattice lattice = lattice_at(solid, 0.19);
  expect_stops_wherever_it_is_asked(7,
                                    [&](ExecutionContext* context) { LatticeCuts(solid, lattice, context); });
}

TEST(LatticeCutsTest, FindTheGapBetweenTwoBoxes) {
  // The gap, 2 to 2.1, lies between the lattice's places along x at 1.45 and 2.45.
  const Mesh mesh = joined(make_box(2, 4, 4), moved(make_box(1.8, 4, 4), {2.1, 0, 0}));
  const Solid solid = make_solid(mesh);
  const Lattice lattice = lattice_at(solid, 1);
  const LatticeCuts cuts(solid, lattice);
  const SamplePlaces places(solid, lattice);
  std::size_t gaps = 0;
  for_each_edge(lattice, [&](const Indices& from, const Indices& to, unsigned step, bool in, bool out) {
    if (!in || !out) return;
    const LatticeCut* cut = cuts.find(cuts.edge(from[0], from[1], from[2], step));
    const bool across = at(places, from, to, 0).x < 2.05 && at(places, from, to, 1).x > 2.05;
    ASSERT_EQ(cut != nullptr, across);
    if (cut == nullptr) return;
    ++gaps;
    EXPECT_TRUE(cut->gap);
    EXPECT_NEAR(at(places, from, to, cut->leaves).x, 2, 1e-12);
    EXPECT_NEAR(at(places, from, to, cut->enters).x, 2.1, 1e-12);
  });
  EXPECT_EQ(gaps, 4u * 4 + 2 * 3 * 4 + 3 * 3);  // the steps along x, with y or z, with both
}

// A lattice that is `length` places long along one axis, with the solid at its lower end.
Lattice lattice_from_the_corner(const Solid& solid, std::size_t axis, std::uint32_t length) {
  LatticeGrid grid;
  grid.axes = {Vec3{0.125, 0, 0}, Vec3{0, 0.125, 0}, Vec3{0, 0, 0.125}};
  grid.origin = {-0.53125, -0.53125, -0.53125};
  grid.dims = {9, 9, 9};
  grid.dims[axis] = length;
  return make_lattice(solid, grid);
}

// A sheared frame of the long lattice has 2^36 lines: words for all of them fit in no memory.
TEST(LatticeCutsTest, DependOnTheSolidNotOnTheLengthOfTheLattice) {
  const Solid solid = make_solid(make_sphere(1, 320));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Lattice near = lattice_from_the_corner(solid, axis, 9);
    const Lattice far = lattice_from_the_corner(solid, axis, 1U << 18);
    ASSERT_EQ(near.points, far.points);
    const LatticeCuts expected(solid, near), found(solid, far);
    std::size_t met = 0;
    for_each_edge(near, [&](const Indices& from, const Indices&, unsigned step, bool, bool) {
      const LatticeCut* e = expected.find(expected.edge(from[0], from[1], from[2], step));
      const LatticeCut* f = found.find(found.edge(from[0], from[1], from[2], step));
      ASSERT_EQ(e == nullptr, f == nullptr);
      if (e == nullptr) return;
      ++met;
      // Places are counted from the far end of the long lattice: 2^18 steps cost as many last digits.
      EXPECT_NEAR(f->leaves, e->leaves, 1e-8);
      EXPECT_NEAR(f->enters, e->enters, 1e-8);
      EXPECT_EQ(f->gap, e->gap);
    });
    EXPECT_EQ(met, expected.all().size());
    EXPECT_EQ(met, found.all().size());
    EXPECT_GT(met, 500u);
  }
}

TEST(LatticeCutsTest, OfABoxAreAsManyAlongEachStepInEveryOrderOfTheAxes) {
  // Every place of the lattice lies in the box, those at its ends half a step from the faces.
  for (const std::array<std::int64_t, 3>& n : std::vector<std::array<std::int64_t, 3>>{
           {200, 6, 4}, {6, 200, 4}, {6, 4, 200}, {40, 50, 2}, {40, 2, 50}, {2, 40, 50}}) {
    const Solid solid =
        make_solid(make_box(static_cast<double>(n[0]), static_cast<double>(n[1]), static_cast<double>(n[2])));
    const LatticeCuts cuts(solid, lattice_at(solid, 1));
    std::array<std::int64_t, 8> leaving{};
    for (const LatticeCut& cut : cuts.all()) leaving[cut.edge % 8] += cut.leaves > 0 && cut.leaves < 1;
    for (std::int64_t step = 1; step < 8; ++step) {
      // An edge leaves the box from every place without a neighbour by that step.
      std::int64_t all = 1, kept = 1;
      for (std::size_t a = 0; a < 3; ++a) {
        all *= n[a];
        kept *= n[a] - ((step >> (2 - a)) & 1);
      }
      EXPECT_EQ(leaving[static_cast<std::size_t>(step)], all - kept) << step;
    }
  }
}

}  // namespace
}  // namespace affskel::core

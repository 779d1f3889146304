#include "core/lattice_cuts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "core/shapes.h"
#include "core/slab_index.h"
#include "test_solids.h"

namespace affskel::core {
namespace {

using Place = std::array<std::int64_t, 3>;

Lattice lattice_of(const Solid& solid, double spacing) {
  LatticeOptions options;
  options.spacing = spacing;
  return make_lattice(solid, options);
}

// Visits every edge with both ends' ranks.
void for_each_edge(const Lattice& lattice,
                   const std::function<void(const Place&, const Place&, unsigned, bool, bool)>& visit) {
  const auto dims = lattice.frame.dims;
  SlabIndex ranks(lattice);
  for (std::int64_t i = -1; i < dims[0]; ++i) {
    if (i + 1 < dims[0]) ranks.move_to(static_cast<std::uint32_t>(i + 1));
    for (std::int64_t j = -1; j < dims[1]; ++j) {
      for (std::int64_t k = -1; k < dims[2]; ++k) {
        for (unsigned step = 1; step < 8; ++step) {
          const Place from{i, j, k}, to{i + ((step >> 2) & 1), j + ((step >> 1) & 1), k + (step & 1)};
          const auto inside = [&](const Place& p) {
            return ranks.at(p[0], p[1], p[2]) != SlabIndex::kOutside;
          };
          visit(from, to, step, inside(from), inside(to));
        }
      }
    }
  }
}

Vec3 at(const SamplePlaces& places, const Place& from, const Place& to, double share) {
  Vec3 x = places.origin();
  for (std::size_t a = 0; a < 3; ++a) {
    x = x + (static_cast<double>(from[a]) + share * static_cast<double>(to[a] - from[a])) * places.axes()[a];
  }
  return x;
}

TEST(LatticeCutsTest, MeetABallsSurfaceOnEveryEdgeThatLeavesIt) {
  // No place of the lattice lies on the surface; sagitta of 20480 triangles: 0.0013.
  const Solid solid = make_solid(make_sphere(1, 20000));
  const Lattice lattice = lattice_of(solid, 0.19);
  const LatticeCuts cuts(solid, lattice);
  const SamplePlaces places(solid, lattice);
  std::size_t crossed = 0;
  for_each_edge(lattice, [&](const Place& from, const Place& to, unsigned step, bool in, bool out) {
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

TEST(LatticeCutsTest, FindTheGapBetweenTwoBoxes) {
  // The plane of the gap, 2 to 2.1, lies between the lattice's places along x at 1.55 and 2.55.
  const Mesh mesh = joined(make_box(2, 4, 4), moved(make_box(2, 4, 4), {2.1, 0, 0}));
  const Solid solid = make_solid(mesh);
  const Lattice lattice = lattice_of(solid, 1);
  const LatticeCuts cuts(solid, lattice);
  const SamplePlaces places(solid, lattice);
  for_each_edge(lattice, [&](const Place& from, const Place& to, unsigned step, bool in, bool out) {
    if (!in || !out) return;
    const LatticeCut* cut = cuts.find(cuts.edge(from[0], from[1], from[2], step));
    const bool across = at(places, from, to, 0).x < 2.05 && at(places, from, to, 1).x > 2.05;
    ASSERT_EQ(cut != nullptr, across);
    if (cut == nullptr) return;
    EXPECT_TRUE(cut->gap);
    EXPECT_NEAR(at(places, from, to, cut->leaves).x, 2, 1e-12);
    EXPECT_NEAR(at(places, from, to, cut->enters).x, 2.1, 1e-12);
  });
}

}  // namespace
}  // namespace affskel::core

#include "core/collapse/limb_tips.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/collapse/collapse.h"
#include "core/collapse/lattice_solids.h"
#include "core/curve/tubes.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/lattice/lattice_points.h"
#include "core/ridge/local_depth.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Where the tips lie, mesh coordinates.  Heights are depths, and rise along `uphill`.
std::vector<Vec3> tips_of(const Mesh& mesh, double spacing, const Vec3& uphill = {}) {
  const LatticeSolid solid(mesh, spacing);
  const DualComplex complex(solid.lattice);
  const SamplePlaces places(solid.solid, solid.lattice);
  const std::vector<float> depth = surface_distance(solid.lattice);
  std::vector<double> height(depth.begin(), depth.end());
  for_each_point(solid.lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
    height[rank] += 10 + dot(uphill, places.at(i, j, k));
  });
  std::vector<Vec3> result;
  for (const LimbTip& tip : limb_tips(thinned_solid(complex, depth, height), 1).tips) {
    const std::uint32_t cube = DualComplex::cube_of(tip.vertex);
    const LatticePlace at = lattice_places(solid.lattice, std::vector<std::uint32_t>{cube})[0];
    Vec3 place = places.at(at[0], at[1], at[2]);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t digit = DualComplex::digit(DualComplex::place_of(tip.vertex), axis);
      place = place + 0.5 * (static_cast<double>(digit) - 1) * places.axes()[axis];
    }
    result.push_back(place);
  }
  return result;
}

TEST(LimbTips, OfAFingerAreItsTwoEnds) {
  for (const double spacing : {0.11, 0.2, 0.31}) {
    std::vector<Vec3> tips = tips_of(shaken(make_cylinder(1, 10, 32), 0, 7), spacing);
    ASSERT_EQ(tips.size(), 2U) << spacing;
    EXPECT_GT(norm(tips[0] - tips[1]), 10 - 2 * 1.5);
    EXPECT_LT(norm(tips[0] - tips[1]), 10);
  }
}

// How far the limbs at both ends of what is long reach, in eight positions in the lattice.
std::vector<double> reaches(const Mesh& mesh, double spacing) {
  std::vector<double> result;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    const LatticeSolid solid(shaken(mesh, 0, seed), spacing);
    const DualComplex complex(solid.lattice);
    const std::vector<float> depth = surface_distance(solid.lattice);
    const std::vector<double> height(depth.begin(), depth.end());
    for (const LimbTip& tip : limb_tips(thinned_solid(complex, depth, height), 0.9).tips)
      result.push_back(tip.reach);
  }
  return result;
}

// Lines meet half-way.  A round limb's begins a radius before its end.
TEST(LimbTips, OfARoundLimbReachAsFarAsItDoes) {
  const std::vector<double> found = reaches(make_cylinder(1, 8, 64), 0.11);
  EXPECT_EQ(found.size(), 16U);
  for (const double reach : found) EXPECT_NEAR(reach, 3, 0.7);
}

// The fronts that come from the edges of a bar's end meet where those from its corners do, 2^0.5 times its half width
// later than they began to come; those of an elliptic limb where its sheet ends, which is 4 wide.
TEST(LimbTips, OfAFlatLimbReachAsFarAsItDoes) {
  const std::vector<double> bar = reaches(make_box(2, 2, 10), 0.15);
  EXPECT_EQ(bar.size(), 16U);
  for (const double reach : bar) EXPECT_NEAR(reach, 4 / std::sqrt(2), 0.6);
  Mesh ellipse = make_cylinder(1, 24, 48);
  for (Vec3& place : ellipse.points) place.x *= 4;
  const std::vector<double> flat = reaches(ellipse, 0.2);
  EXPECT_EQ(flat.size(), 16U);
  for (const double reach : flat) EXPECT_NEAR(reach, 2.1, 0.6);
}

TEST(LimbTips, AreNoneOfWhatIsNotLongerThanThick) {
  for (const double spacing : {0.07, 0.11}) {
    EXPECT_TRUE(tips_of(make_sphere(1, 1280), spacing).empty());
    EXPECT_TRUE(tips_of(make_box(2, 2, 2), spacing).empty());
    EXPECT_TRUE(tips_of(shaken(make_box(2, 2, 2), 0, 3), spacing).empty());
    EXPECT_TRUE(tips_of(make_box(6, 3, 1), spacing).empty());
    EXPECT_TRUE(tips_of(shaken(make_box(3, 3, 0.6), 0, 5), spacing).empty());
    EXPECT_TRUE(tips_of(make_torus(2, 0.7, 1024), spacing).empty());
  }
}

// Where a solid is one cube thick, nothing but its place tells one face of a cube from the other.
TEST(LimbTips, OfMirrorImagesAreMirrorImages) {
  int all = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const Mesh right = moved(random_solid(seed), {7, 0, 0});
    Mesh left = right;
    for (Vec3& place : left.points) place.x = -place.x;
    for (Triangle& corners : left.triangles) std::swap(corners[0], corners[1]);
    std::array<std::vector<std::array<double, 3>>, 2> sides;
    for (const Vec3& tip : tips_of(joined(left, right), 0.31, {0, 0.13, 0.29}))
      sides[tip.x > 0].push_back(
          {std::round(1e6 * std::abs(tip.x)), std::round(1e6 * tip.y), std::round(1e6 * tip.z)});
    for (auto& side : sides) std::ranges::sort(side);
    EXPECT_EQ(sides[0], sides[1]) << seed;
    all += static_cast<int>(sides[0].size());
  }
  EXPECT_GT(all, 20);
}

// The edges that no end leads to.
std::vector<DualComplex::Cell> loop_of(const DualComplex& complex, const ThinnedSolid& thinned) {
  std::vector<DualComplex::Cell> edges;
  collapsed(complex, thinned.cells, {}).for_each([&](DualComplex::Cell cell) {
    if (DualComplex::dimension(cell) == 1) edges.push_back(cell);
  });
  return edges;
}

// A stick with a ring at one end, which has no tip while it is a loop.
TEST(LimbTips, OfALimbWithALoopAreThoseWhereItIsCut) {
  const Mesh ring = moved(make_torus(1.2, 0.4, 1024), {7.2, 0.4, 0.4});
  const LatticeSolid solid(joined(make_box(6, 0.8, 0.8), ring), 0.13);
  const DualComplex complex(solid.lattice);
  const std::vector<float> depth = surface_distance(solid.lattice);
  const std::vector<double> height(depth.begin(), depth.end());
  const ThinnedSolid thinned = thinned_solid(complex, depth, height);
  EXPECT_EQ(limb_tips(thinned, 1).tips.size(), 1U);
  const std::vector<DualComplex::Cell> loop = loop_of(complex, thinned);
  ASSERT_GT(loop.size(), 20U);
  const LimbTips cut = limb_tips(thinned, 1, std::vector{loop[loop.size() / 2]});
  EXPECT_GE(cut.tips.size(), 2U);
  bool empty = true;
  cut.left.for_each([&](DualComplex::Cell cell) { empty = empty && DualComplex::dimension(cell) == 0; });
  EXPECT_TRUE(empty);
}

// A fork whose prongs a thread joins, but for a gap in its middle.
Mesh fork(double gap) {
  std::vector<Tube> tubes{{{0, 0, -10}, {0, 0, 0}, 1}};
  for (const double side : {-1.0, 1.0}) {
    tubes.push_back({{0, 0, 0}, {4 * side, 0, 8}, 0.8});
    tubes.push_back({{4 * side, 0, 8}, {0.5 * gap * side, 0, 8}, 0.45});
  }
  return tube_mesh(tubes, 0.2);
}

// Opened there, it has the tips of one that is open.
TEST(LimbTips, OfWhatIsOpenedAreThoseOfWhatIsOpen) {
  std::array<std::vector<LimbTip>, 2> tips;
  for (const bool is_opened : {false, true}) {
    const LatticeSolid solid(fork(is_opened ? 0 : 1.1), 0.21);
    const DualComplex complex(solid.lattice);
    const std::vector<float> depth = surface_distance(solid.lattice);
    const std::vector<double> height(depth.begin(), depth.end());
    const SamplePlaces places(solid.solid, solid.lattice);
    const auto from_middle = [&](DualComplex::Cell cell) {
      const auto at = lattice_places(solid.lattice, std::vector{DualComplex::cube_of(cell)})[0];
      return norm(places.at(at[0], at[1], at[2]) - Vec3{0, 0, 8});
    };
    const ThinnedSolid thinned = thinned_solid(complex, depth, height);
    std::vector<DualComplex::Cell> cuts;
    if (is_opened) {
      EXPECT_EQ(limb_tips(thinned, 0.9).tips.size(), 1U);
      const std::vector<DualComplex::Cell> loop = loop_of(complex, thinned);
      cuts = {*std::ranges::min_element(loop, {}, from_middle)};
    }
    const std::vector<LimbTip>& found = tips[is_opened] = limb_tips(thinned, 0.9, cuts).tips;
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(std::ranges::count_if(found, &LimbTip::is_cut), is_opened ? 2 : 0);
    EXPECT_EQ(std::ranges::count_if(found, [&](const LimbTip& tip) { return from_middle(tip.vertex) < 1.2; }),
              2);
  }
  for (auto& found : tips) std::ranges::sort(found, {}, &LimbTip::reach);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_NEAR(tips[1][n].reach / tips[0][n].reach, 1, 0.15) << n;
    EXPECT_NEAR(tips[1][n].length / tips[0][n].length, 1, 0.15) << n;
  }
}

// The lines from the corners of an end come together at once: none of them is the end.
TEST(LimbTips, OfALathAreTheMiddlesOfItsEnds) {
  for (const double x : {-1, 0, 1}) {
    std::vector<Vec3> tips = tips_of(make_box(2.4, 0.6, 12), 0.11, {x, 0, 0});
    ASSERT_EQ(tips.size(), 2U);
    std::sort(tips.begin(), tips.end(), [](const Vec3& a, const Vec3& b) { return a.z < b.z; });
    for (const Vec3& tip : tips) {
      EXPECT_NEAR(tip.x, 1.2, 0.17) << x << ' ' << tip.z;
      EXPECT_NEAR(tip.y, 0.3, 0.17);
    }
    EXPECT_LT(tips[0].z, 1.2);
    EXPECT_GT(tips[1].z, 10.8);
  }
}

// Every tooth is 3 high and 1 wide; the bar they stand on ends at the outer ones.
TEST(LimbTips, OfACombAreItsTeeth) {
  const std::vector<Vec3> tips = tips_of(comb(4), 0.11);
  EXPECT_EQ(tips.size(), 4U);
}

double to_capsule(const Vec3& p, const Vec3& a, const Vec3& b, double radius) {
  const double along = std::clamp(dot(p - a, b - a) / dot(b - a, b - a), 0.0, 1.0);
  return norm(p - a - along * (b - a)) - radius;
}

// A twig that is as long as thick where it leaves the knob of a stem: births grow fast where it comes to the knob.
TEST(LimbTips, OfATwigOnAKnobAreTheStemsAndTheTwigs) {
  const Vec3 knob{0, 0, 5}, twig{2.51, 0, 5.67};
  ImplicitMeshOptions cubes;
  cubes.low = {-4, -4, -3};
  cubes.high = {6, 4, 9};
  cubes.spacing = 0.25;
  const Mesh mesh = mesh_zero_set(
      [&](const Vec3& p) {
        return std::min(
            {to_capsule(p, {0, 0, 0}, knob, 1), norm(p - knob) - 2.2, to_capsule(p, knob, twig, 0.9)});
      },
      cubes);
  for (const double spacing : {0.15, 0.17, 0.2}) EXPECT_EQ(tips_of(mesh, spacing).size(), 2U) << spacing;
}

}  // namespace
}  // namespace affskel::core

#include "core/curve/limb_hubs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/curve/drawn_lines.h"
#include "core/lattice/lattice_points.h"
#include "core/mesh/polylines.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

constexpr double kCubeSide = 4;

// A cube, and lines through its middle, or from one that is beside it; they go on beyond it.
struct Cube : DrawnLines {
  Lattice lattice;
  Vec3 middle;
  std::vector<double> radius;

  explicit Cube(const Vec3& sides = {kCubeSide, kCubeSide, kCubeSide})
      : Cube(make_box(sides.x, sides.y, sides.z)) {}
  explicit Cube(const Mesh& mesh) {
    LatticeOptions options;
    options.spacing = 0.2;
    lattice = make_lattice(make_solid(mesh), options);
    each_point([&](const Vec3& at, std::uint32_t) {
      middle = middle + (1 / static_cast<double>(lattice.points)) * at;
    });
  }
  template <class Visit>
  void each_point(const Visit& visit) const {
    for_each_point(lattice, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::uint32_t rank) {
      visit(lattice.spacing * Vec3{double(i), double(j), double(k)}, rank);
    });
  }
  // Limbs of 0.5 whose radius grows to `within` towards the joint, by so much of the way, so far from it.
  void go_out(std::uint32_t joint, const std::vector<Vec3>& steps, double within, double grows,
              double from = 2) {
    radius.resize(places.size(), within);
    for (const Vec3& step : steps) {
      go(joint, step, 80, 0.5);
      for (int n = 1; n <= 80; ++n)
        radius.push_back(std::max(0.5, std::min(within, 0.5 + grows * (from - 0.1 * n))));
    }
  }
  LimbHubs found() const {
    std::vector<std::uint32_t> nearest(lattice.points, 0);
    each_point([&](const Vec3& at, std::uint32_t rank) {
      for (std::uint32_t v = 1; v < places.size(); ++v)
        if (norm(places[v] - at) < norm(places[nearest[rank]] - at)) nearest[rank] = v;
    });
    return limb_hubs({places, polylines(places.size(), segments), radius, lattice, nearest});
  }
};

const std::vector<Vec3> kCross{{0.1, 0, 0}, {0, 0.1, 0}, {-0.1, 0, 0}, {0, -0.1, 0}};

TEST(LimbHubs, AreAsLargeAsWhatNoLimbHas) {
  Cube cube;
  const std::uint32_t joint = cube.add(cube.middle, 2);
  cube.go_out(joint, kCross, 2.2, 2, 3.5);  // beyond the ellipsoid
  const LimbHubs found = cube.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  const LimbHub& hub = found.hubs[0];
  EXPECT_EQ(hub.joint, joint);
  EXPECT_LT(norm(hub.centre - cube.middle), 1e-9);
  const double axis = 1.1 * std::sqrt(5.0 / 12) * kCubeSide;  // of the ellipsoid with a cube's moments
  for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{0, 0.6, 0.8}})
    for (const double off : {-0.1, 0.1})
      EXPECT_NEAR(hub.outside(cube.middle + (axis + off) * way), off, 0.02);
  EXPECT_LT(hub.outside(cube.middle), 0);
  for (std::uint32_t v = 0; v < cube.places.size(); ++v)
    EXPECT_EQ(found.at(v) == &hub, norm(cube.places[v] - cube.middle) < axis) << v;
}

TEST(LimbHubs, TheRimOfAFlatOneIsAsFarAsItIs) {
  const LimbHub plate{0, {}, {{{1. / 400, 0, 0}, {0, 1. / 400, 0}, {0, 0, 1}}}};  // 20 wide, 1 high
  EXPECT_NEAR(plate.outside({15, 0, 1}), 1 - std::sqrt(1 - 0.75 * 0.75), 0.1)
      << "above it, not towards its centre";
  EXPECT_NEAR(plate.outside({21, 0, 0}), 1, 0.05);
  EXPECT_NEAR(plate.outside({0, 0, 3}), 2, 1e-12);
}

// A body with a link of so many vertices between two joints, and two limbs at each.
void expect_one_hub_of_two_joints(Cube body, const Vec3& first, int vertices, double radius) {
  const std::uint32_t one = body.add(body.middle + first, 2);
  const std::uint32_t other = body.go(one, {0.1, 0, 0}, vertices, 1);
  body.radius.assign(body.places.size(), radius);
  body.go_out(one, {{-0.1, 0, 0}, {0, -0.1, 0}}, 1.5, 1.5);
  body.go_out(other, {{0.1, 0, 0}, {0, 0.1, 0}}, 1.5, 1.5);
  const LimbHubs found = body.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  EXPECT_EQ(found.of[one], 0U);
  EXPECT_EQ(found.of[other], 0U);
  EXPECT_LT(norm(found.hubs[0].centre - body.middle), 0.05);
}

// Lines beside the cube's middle, from arm to arm, and a link between them that is shorter than thick.
TEST(LimbHubs, AreOneHoweverLinesRunInThem) {
  expect_one_hub_of_two_joints(Cube(), {-1, 0, -1.5}, 20, 1.1);
}

// The lattice makes one about a gap thinner than a spacing, and joints that move draw it together.
TEST(LimbHubs, HaveLoopsThatAreShorterThanThick) {
  Cube cube;
  const std::uint32_t joint = cube.add(cube.middle, 2);
  cube.go_out(joint, kCross, 1.5, 1.5);
  const std::uint32_t a = cube.add(cube.middle + Vec3{0.01, 0, 0}, 2), b = cube.add(cube.middle, 2);
  cube.radius.resize(cube.places.size(), 10);
  cube.join(joint, a);
  cube.join(a, b);
  cube.join(b, joint);
  ASSERT_EQ(cube.found().hubs.size(), 1U);
}

TEST(LimbHubs, AreNotWhereLimbsGrowSlowly) {
  Cube cube;
  cube.go_out(cube.add(cube.middle, 2), kCross, 2.2, 0.3);
  EXPECT_TRUE(cube.found().hubs.empty());
}

// Four limbs, and one upwards of so many vertices, so thick.
Cube cube_with_limb(int vertices, double radius) {
  Cube cube;
  const std::uint32_t joint = cube.add(cube.middle, 2);
  cube.go_out(joint, kCross, 2.2, 2);
  cube.go(joint, {0, 0, 0.1}, vertices, radius);
  cube.radius.resize(cube.places.size(), radius);
  return cube;
}

// A ball as large as what that limb leaves of the cube has 2.16.
TEST(LimbHubs, AreNotWhereALimbIsAsThick) {
  EXPECT_TRUE(cube_with_limb(80, 1.6).found().hubs.empty());
  EXPECT_EQ(cube_with_limb(80, 1.5).found().hubs.size(), 1U) << "as a seat with a back, that is thick alone";
}

// Here the walls of a hollow cube, of which no limb has anything, with lines within.
TEST(LimbHubs, AreNoNetworks) {
  const double inside = kCubeSide - 0.8;
  const Vec3 wall{0.4, 0.4, 0.4};
  Cube cube(joined(make_box(kCubeSide, kCubeSide, kCubeSide),
                   reversed(moved(make_box(inside, inside, inside), wall))));
  cube.go_out(cube.add(cube.middle, 2), kCross, 2.2, 2, 3.5);
  EXPECT_TRUE(cube.found().hubs.empty());
}

// A limb grows where it turns a corner: of a bar with thin arms nothing else makes a hub.
TEST(LimbHubs, AreNoBars) {
  for (const double length : {6., 8.}) {
    Cube bar({2, 2, length});
    bar.go_out(bar.add(bar.middle, 2), kCross, 1.5, 1.5);
    EXPECT_EQ(bar.found().hubs.size(), length < 3.5 * 2 ? 1U : 0U) << length;
  }
}

// A shell as thick as its cavity is wide, as the ring of a gear: what hangs on it hangs on no ball.
TEST(LimbHubs, AreNoRings) {
  const double inside = kCubeSide / 3;
  Cube cube(joined(make_box(kCubeSide, kCubeSide, kCubeSide),
                   reversed(moved(make_box(inside, inside, inside), {inside, inside, inside}))));
  cube.go_out(cube.add(cube.middle, 2), kCross, 2.2, 2, 3.5);
  EXPECT_TRUE(cube.found().hubs.empty());
}

TEST(LimbHubs, HoldASpur) {
  const Cube cube = cube_with_limb(20, 0.5);
  const LimbHubs found = cube.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  EXPECT_EQ(found.of.back(), 0U);
}

// 5.2 long, in a cube that is as thick as a ball of 4.96.
TEST(LimbHubs, HoldNoLimbsEnd) {
  Cube cube = cube_with_limb(18, 0.5);
  const std::uint32_t aside = cube.go(cube.segments.back()[1], {0.1, 0, 0}, 18, 0.5);
  cube.go(aside, {0, 0, -0.1}, 16, 0.5);
  cube.radius.resize(cube.places.size(), 0.5);
  EXPECT_TRUE(cube.found().hubs.empty());
}

// A seat whose two joints are farther apart than what is nearest to the link between them is thick, by its volume.
TEST(LimbHubs, AreAsWideAsAPlate) {
  expect_one_hub_of_two_joints(Cube({12, 12, 2}), {-2.5, 0, 0}, 50, 2.4);
}

}  // namespace
}  // namespace affskel::core

#include "core/curve/limb_hubs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
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
  std::vector<double> radius, section;  // as much as the radius where not told

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
  // Sections like a body's so far from its middle, and a limb's beyond.
  void open_until(double way) {
    section.clear();
    for (const Vec3& at : places) section.push_back(norm(at - middle) < way ? 1.5 : 0.5);
  }
  LimbHubs found() const {
    std::vector<std::uint32_t> nearest(lattice.points, 0);
    each_point([&](const Vec3& at, std::uint32_t rank) {
      for (std::uint32_t v = 1; v < places.size(); ++v)
        if (norm(places[v] - at) < norm(places[nearest[rank]] - at)) nearest[rank] = v;
    });
    return limb_hubs({places, polylines(places.size(), segments), radius, section.empty() ? radius : section,
                      lattice, nearest});
  }
};

const std::vector<Vec3> kCross{{0.1, 0, 0}, {0, 0.1, 0}, {-0.1, 0, 0}, {0, -0.1, 0}};

// Of a cube with four limbs, 8 long, which have all beyond `end`.
void expect_hub_until(double end, const Cube& cube) {
  const LimbHubs found = cube.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  for (std::uint32_t v = 0; v < cube.places.size(); ++v)
    EXPECT_EQ(found.of[v] == 0, norm(cube.places[v] - cube.middle) < end) << v;
}

TEST(LimbHubs, AreAsLargeAsWhatNoLimbHas) {
  Cube cube;
  const std::uint32_t joint = cube.add(cube.middle, 2);
  cube.go_out(joint, kCross, 2.2, 2, 3.5);                    // beyond the ellipsoid
  const double axis = 1.1 * std::sqrt(5.0 / 12) * kCubeSide;  // of the ellipsoid with a cube's moments
  cube.open_until(axis);
  const LimbHubs found = cube.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  const LimbHub& hub = found.hubs[0];
  EXPECT_EQ(hub.joint, joint);
  EXPECT_LT(norm(hub.centre - cube.middle), 1e-9);
  for (const Vec3& way : {Vec3{1, 0, 0}, Vec3{0, 0.6, 0.8}})
    for (const double off : {-0.1, 0.1})
      EXPECT_NEAR(hub.outside(cube.middle + (axis + off) * way), off, 0.02);
  EXPECT_LT(hub.outside(cube.middle), 0);
  expect_hub_until(axis, cube);
}

void expect_one_hub(const Cube& body, std::uint32_t one, std::uint32_t other, double tolerance) {
  const LimbHubs found = body.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  EXPECT_EQ(found.of[one], 0U);
  EXPECT_EQ(found.of[other], 0U);
  EXPECT_LT(norm(found.hubs[0].centre - body.middle), tolerance);
}

// A body with a link of so many vertices between two joints, and two limbs at each.
void expect_one_hub_of_two_joints(Cube body, const Vec3& first, int vertices, double radius) {
  const std::uint32_t one = body.add(body.middle + first, 2);
  const std::uint32_t other = body.go(one, {0.1, 0, 0}, vertices, 1);
  body.radius.assign(body.places.size(), radius);
  body.go_out(one, {{-0.1, 0, 0}, {0, -0.1, 0}}, 1.5, 1.5);
  body.go_out(other, {{0.1, 0, 0}, {0, 0.1, 0}}, 1.5, 1.5);
  expect_one_hub(body, one, other, 0.05);
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

// Where limbs grow slowly towards it; a sample point lies half a spacing from the middle, along each axis.
TEST(LimbHubs, AreThereWhetherOrNotASamplePointIsNearestToTheirJoint) {
  for (const double aside : {0., 0.1}) {
    Cube cube;
    const std::uint32_t joint = cube.add(cube.middle + Vec3{aside, aside, aside}, 2);
    cube.go_out(joint, kCross, 2.2, 0.3);
    ASSERT_EQ(cube.found().hubs.size(), 1U) << aside;
    EXPECT_EQ(cube.found().hubs[0].joint, joint) << aside;
  }
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

// A ball as large as the cube has 2.48.
TEST(LimbHubs, AreNotWhereALimbIsAsThick) {
  EXPECT_TRUE(cube_with_limb(80, 1.9).found().hubs.empty());
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

// A seat between two arms fills 0.68 of its ellipsoid.
TEST(LimbHubs, AreSeatsWithArms) {
  Cube chair(joined(joined(make_box(8, 8, 2.4), moved(make_box(8, 1.2, 4), {0, 0, 0})),
                    moved(make_box(8, 1.2, 4), {0, 6.8, 0})));
  const std::uint32_t joint = chair.add(chair.middle, 2);
  chair.go_out(joint, {{0.1, 0, 0}, {0, 0.1, 0}, {-0.1, 0, 0}, {0, -0.1, 0}}, 2.2, 2, 4.2);
  EXPECT_EQ(chair.found().hubs.size(), 1U);
}

// The lines of a palm meet at its edge, and what is nearest to their joint is little of it.
TEST(LimbHubs, BeginWithWhatLiesAboutABody) {
  Cube palm({8, 8, 2});
  const std::uint32_t joint = palm.add(palm.middle + Vec3{-1.5, 0, 0}, 2);
  palm.go_out(joint, {{0.1, 0, 0}, {0.07, 0.07, 0}, {0.07, -0.07, 0}, {-0.1, 0, 0}}, 1.5, 1, 0.6);
  const LimbHubs found = palm.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  EXPECT_LT(norm(found.hubs[0].centre - palm.middle), 1);
}

// Under an octopus's head lines run from arm to arm: what is nearest to them is the head above.
TEST(LimbHubs, HaveWhatIsNearestToLinesAlongTheirRim) {
  Cube head;
  const std::uint32_t joint = head.add(head.middle - Vec3{0, 0, 1.95}, 2);
  head.go_out(joint, kCross, 1.5, 1, 0.6);
  head.open_until(2.8);
  const LimbHubs found = head.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  EXPECT_LT(norm(found.hubs[0].centre - head.middle), 0.05);
}

// A plate, and bars on one side of it that begin within its ellipsoid.
TEST(LimbHubs, AreWhatTheirLimbsLeave) {
  Mesh fork = make_box(3, 6, 1);
  for (const double y : {0., 1.8, 3.6, 5.4}) fork = joined(fork, moved(make_box(6, 0.6, 1.4), {3, y, -0.2}));
  Cube cube(fork);
  cube.middle = cube.middle - Vec3{cube.middle.x - 1.5, 0, 0};
  const std::uint32_t joint = cube.add(cube.middle, 2);
  for (const double y : {-2.7, -0.9, 0.9, 2.7})
    cube.go_out(cube.go(joint, {0, y / 10, 0}, 10, 1.5), {{0.1, 0, 0}}, 1.5, 1, 3.4);
  cube.section.clear();
  for (const Vec3& at : cube.places) cube.section.push_back(at.x < cube.middle.x + 1.4 ? 1.5 : 0.5);
  const LimbHubs found = cube.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  for (std::uint32_t v = 0; v < cube.places.size(); ++v)
    EXPECT_EQ(found.of[v] == 0, cube.places[v].x < cube.middle.x + 1.4) << v << ": tines have none of it";
}

// A limb grows where it turns a corner: of a bar with thin arms nothing else makes a hub.
TEST(LimbHubs, AreNoBars) {
  for (const double length : {4., 6.}) {
    Cube bar({2, 2, length});
    bar.go_out(bar.add(bar.middle, 2), kCross, 1.5, 1.5);
    EXPECT_EQ(bar.found().hubs.size(), length < 2.25 * 2 ? 1U : 0U) << length;
  }
}

// With a branch beside it the end of a bar is a ball of 1.42 sections, as thick across as the rest.
TEST(LimbHubs, AreNotTheEndsOfBars) {
  for (const double thick : {1.12, 0.9}) {
    Cube bar({2, 2, 4.4});
    const std::uint32_t joint = bar.add(bar.middle, 2);
    bar.go_out(joint, kCross, 1.5, 1.5);
    bar.go(joint, {0, 0, 0.1}, 80, thick);
    for (int n = 1; n <= 80; ++n) bar.radius.push_back(std::max(thick, 1.5 - std::max(0.0, 0.15 * n - 3)));
    EXPECT_EQ(bar.found().hubs.size(), thick < 1 ? 1U : 0U) << thick;
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

// 5.4 long to where it leaves the ellipsoid, and 1.6 or 5 beyond; the cube is as thick as a ball of 4.96.
TEST(LimbHubs, HoldNoTwoThirdsOfALimbUnlessFarThicker) {
  const auto hubs = [](double radius, int beyond) {
    Cube cube = cube_with_limb(10, radius);
    std::uint32_t at = cube.segments.back()[1];
    for (const Vec3& step : {Vec3{0.1, 0, 0}, Vec3{0, 0.1, 0}, Vec3{0, 0, -0.1}})
      at = cube.go(at, step, 10, radius);
    cube.go(at, {0.07, 0.07, 0}, 14 + beyond, radius);
    cube.radius.resize(cube.places.size(), radius);
    cube.open_until(2.84);
    return cube.found().hubs.size();
  };
  EXPECT_EQ(hubs(1.1, 16), 0U);
  EXPECT_EQ(hubs(1.1, 50), 1U);
  EXPECT_EQ(hubs(0.5, 16), 1U) << "as an elephant's leg";
}

// A seat whose two joints are farther apart than what is nearest to the link between them is thick, by its volume.
TEST(LimbHubs, AreAsWideAsAPlate) {
  expect_one_hub_of_two_joints(Cube({12, 12, 2}), {-2.5, 0, 0}, 50, 2.4);
}

// A rod that passes through a body whose own lines meet beside it.
TEST(LimbHubs, HoldNoMiddleOfALimb) {
  for (const bool passes : {false, true}) {
    Cube cube;
    const std::uint32_t joint = cube.add(cube.middle, 2);
    cube.go_out(joint, kCross, 2.2, 2, 3.5);
    if (passes) cube.go(cube.add(cube.middle + Vec3{-6, 1, 1}, 0.5), {0.1, 0, 0}, 120, 0.5);
    cube.radius.resize(cube.places.size(), 0.5);
    cube.open_until(2.84);
    EXPECT_EQ(cube.found().hubs.size(), passes ? 0U : 1U);
  }
}

// Four fingers, and a wrist of so many vertices, so thick. @return its end.
std::uint32_t go_out_of_palm(Cube& palm, std::uint32_t joint, int vertices, double thick) {
  palm.radius.assign(1, 2.2);
  const std::uint32_t wrist = palm.go(joint, {0, -0.1, 0}, vertices, thick);
  palm.radius.resize(palm.places.size(), thick);
  palm.go_out(joint, {{0.1, 0, 0}, {0.06, 0.08, 0}, {-0.06, 0.08, 0}, {-0.1, 0, 0}}, 2.2, 2, 4.2);
  return wrist;
}

// A palm, 8 wide and 2 thick, with four fingers, and a forearm as thick as it, along which its ellipsoid would go on and on.
TEST(LimbHubs, DoNotRunAlongALimb) {
  Cube palm(joined(moved(make_box(8, 8, 2), {0, 8, 0}), moved(make_box(4.6, 8.5, 2), {1.7, 0, 0})));
  const Vec3 middle{4, 12, 1};
  const std::uint32_t joint = palm.add(middle, 2);
  const std::uint32_t wrist = go_out_of_palm(palm, joint, 100, 1.7);
  const LimbHubs found = palm.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  EXPECT_EQ(found.of[wrist], kNone);
  EXPECT_LT(norm(found.hubs[0].centre - middle), 2);
}

// A palm with a wrist that is shorter than it is thick, and thick enough for its ellipsoid to reach the wrist's end.
TEST(LimbHubs, HoldNoWholeLimb) {
  Cube palm(joined(moved(make_box(8, 8, 2), {0, 2.4, 0}), moved(make_box(4, 2.5, 2), {2, 0, 0})));
  const std::uint32_t joint = palm.add({4, 6.4, 1}, 2);
  const std::uint32_t wrist = go_out_of_palm(palm, joint, 55, 1.6);
  const LimbHubs found = palm.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  for (std::uint32_t n = 0; n < 10; ++n) EXPECT_EQ(found.of[wrist - n], kNone) << n;
  EXPECT_EQ(found.of[joint], 0U);
}

// Joints lie under an octopus's head, and a line that leads up to its top is longer than half as that is thick.
TEST(LimbHubs, HoldALineThatEndsInThemWhereNoneElseIsThere) {
  for (const int vertices : {20, 26, 30, 35}) {
    Cube head;
    const std::uint32_t joint = head.add(head.middle - Vec3{0, 0, 1.5}, 2);
    head.go_out(joint, kCross, 2.2, 2);
    head.go(joint, {0, 0, 0.1}, vertices, 0.5);
    head.radius.resize(head.places.size(), 0.5);
    EXPECT_EQ(head.found().hubs.size(), 1U) << vertices;
  }
}

// A body twice as long as wide, with a joint in either half, and a line between them that leads round: from twice the
// ellipsoid of either half it is one.
TEST(LimbHubs, AreOneOfTwoHalves) {
  Cube body({10, 5, 5});
  const std::uint32_t one = body.add(body.middle + Vec3{-2.5, 0, 0}, 2);
  const std::uint32_t other = body.add(body.middle + Vec3{2.5, 0, 0}, 2);
  const std::uint32_t corner = body.add(body.middle + Vec3{0, 2.4, 2.4}, 0.5);
  body.join(one, corner);
  body.join(corner, other);
  body.radius = {3, 3, 0.5};
  body.go_out(one, {{-0.1, 0, 0}, {0, 0.1, 0}, {0, -0.1, 0}}, 2.2, 2, 3.5);
  body.go_out(other, {{0.1, 0, 0}, {0, 0.1, 0}, {0, -0.1, 0}}, 2.2, 2, 3.5);
  expect_one_hub(body, one, other, 0.2);
}

// The ellipsoid of a cube reaches 2.84 from its middle.
TEST(LimbHubs, EndWhereTheirLimbsHaveSectionsAsBeyond) {
  for (const double end : {2.25, 3.25}) {
    Cube cube;
    cube.go_out(cube.add(cube.middle, 2), kCross, 2.2, 2, 3.5);
    cube.open_until(end);
    expect_hub_until(end, cube);
  }
}

// As fingers, and tines of a fork; what grows faster goes over into the body.
TEST(LimbHubs, EndWhereTheirLimbsTaperAsBeyond) {
  for (const double taper : {0.1, 0.3}) {
    Cube cube;
    cube.go_out(cube.add(cube.middle, 2), kCross, 2.2, 2, 3.5);
    for (const Vec3& at : cube.places) {
      const double way = norm(at - cube.middle);
      cube.section.push_back(way < 2.25 ? 1.9 : 0.5 + taper * (8 - way));
    }
    expect_hub_until(taper < 0.2 ? 2.25 : 2.84, cube);
  }
}

// Noise makes forks in thin limbs to which no sample point is nearest.
TEST(LimbHubs, AreNotOfNothing) {
  Cube cube({4, 4, 3});
  const std::uint32_t joint = cube.add(cube.middle, 2);
  cube.go_out(joint, kCross, 2.2, 2, 3.5);
  cube.open_until(2.84);
  const std::uint32_t fork = cube.segments.back()[1];
  for (const Vec3& far : {Vec3{50, 0, 0}, Vec3{0, 50, 0}})
    cube.join(fork, cube.add(cube.places[fork] + far, 0.5));
  cube.radius.resize(cube.places.size(), 0.5);
  cube.section.resize(cube.places.size(), 0.5);
  const LimbHubs found = cube.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  EXPECT_EQ(found.of[fork], kNone);
}

// Two bodies as large: what a link has beyond its middle is the other's, and tells nothing of how thick it is itself.
TEST(LimbHubs, PartALinkByTheHalfThatIsNear) {
  Cube both(joined(joined(make_box(4, 4, 4), moved(make_box(4, 4, 4), {5, 0, 0})),
                   moved(make_box(2, 1, 1), {3.5, 1.5, 1.5})));
  const std::uint32_t one = both.add({2, 2, 2}, 2);
  const std::uint32_t other = both.go(one, {0.1, 0, 0}, 50, 0.5);
  both.radius.assign(both.places.size(), 0.5);
  for (const auto& [joint, side] : {std::pair(one, -0.1), std::pair(other, 0.1)})
    both.go_out(joint, {{side, 0, 0}, {0, 0.1, 0}, {0, -0.1, 0}}, 2.2, 2, 3.5);
  both.section = both.radius;
  for (std::uint32_t v = one; v <= other; ++v)
    both.section[v] = std::abs(both.places[v].x - 4.5) < 0.6 ? 0.5 : 2.2;
  const LimbHubs found = both.found();
  ASSERT_EQ(found.hubs.size(), 2U);
  for (std::uint32_t v = one; v <= other; ++v)
    if (std::abs(both.places[v].x - 4.5) > 1) {
      EXPECT_NE(found.of[v], kNone) << both.places[v].x;
    }
}

// A torso, and with the head before it, which fills less of an ellipsoid.
TEST(LimbHubs, AreWhatFillsItsEllipsoidBest) {
  Cube beast(joined(
      joined(make_box(6, 6, 4), moved(make_box(1.5, 1.2, 1.2), {6, 2.4, 1.4})),
      joined(moved(make_box(4, 4, 3), {7.5, 1, 0.5}), moved(make_box(6, 0.6, 0.6), {11.5, 2.7, 1.7}))));
  beast.middle = {3, 3, 2};
  const std::uint32_t joint = beast.add(beast.middle, 2);
  beast.radius.assign(1, 2.5);
  const std::uint32_t trunk = beast.go(joint, {0.1, 0, 0}, 143, 0.8);
  beast.radius.resize(beast.places.size(), 0.8);
  beast.go_out(joint, {{-0.1, 0, 0}, {0, 0.1, 0}, {0, -0.1, 0}}, 2.2, 2, 3.5);
  beast.open_until(4);
  for (std::uint32_t v = joint; v <= trunk; ++v) {
    const double x = beast.places[v].x;
    beast.section[v] = x < 6 ? 2.5 : x < 7.5 ? 0.6 : x < 11.5 ? 1.9 : 0.3;
  }
  const LimbHubs found = beast.found();
  ASSERT_EQ(found.hubs.size(), 1U);
  EXPECT_LT(norm(found.hubs[0].centre - beast.middle), 1);
}

// A ray is all wings: most of what lies in a hub there is their tips'.
TEST(LimbHubs, HaveLittleOfTips) {
  Cube ray({14, 14, 2});
  ray.go_out(ray.add(ray.middle, 2), kCross, 1, 0);
  ray.open_until(5);
  EXPECT_TRUE(ray.found().hubs.empty());
}

// The shape of less is chance.
TEST(LimbHubs, AreThreeSpacingsThick) {
  for (const double thick : {0.4, 0.8}) {
    Cube plate({4, 4, thick});
    plate.go_out(plate.add(plate.middle, 2), kCross, 0.5, 0);
    plate.open_until(2.84);
    EXPECT_EQ(plate.found().hubs.size(), thick > 3 * 0.2 ? 1U : 0U) << thick;
  }
}

}  // namespace
}  // namespace affskel::core

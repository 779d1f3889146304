#include "core/curve/limb_tubes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/none.h"
#include "core/curve/drawn_lines.h"

namespace affskel::core {
namespace {

struct Tubed : DrawnLines {
  // A limb is round; along one axis it may be so many times as wide.
  std::function<Vec3(const Vec3& place)> wide = [](const Vec3&) { return Vec3{1, 1, 1}; };

  std::vector<LimbFork> forks;    // of the joint, which is the first vertex
  std::vector<LimbHub> hubs;      // at most one
  std::uint32_t of_hub = 0;       // vertices before that are the hub's
  std::size_t little = SIZE_MAX;  // from that vertex on little is nearest

  std::uint32_t nearest(const Vec3& at) const {
    std::uint32_t best = 0;
    for (std::uint32_t v = 0; v < places.size(); ++v)
      if (norm(places[v] - at) < norm(places[best] - at)) best = v;
    return best;
  }
  Vec3 owner(const Vec3& at) const { return owner(at, nearest(at)); }
  Vec3 owner(const Vec3& at, std::uint32_t from) const {
    const auto ellipse = [&](const Vec3& place, const Vec3& u, const Vec3& v, double) {
      const Vec3 axes = ball[nearest(place)] * wide(place);
      const auto inverse_square = [&](const Vec3& a, const Vec3& b) {
        return a.x * b.x / (axes.x * axes.x) + a.y * b.y / (axes.y * axes.y) + a.z * b.z / (axes.z * axes.z);
      };
      const double uu = inverse_square(u, u), vv = inverse_square(v, v);
      return LimbEllipse{0.5 * (uu + vv), 0.5 * (uu - vv), inverse_square(u, v)};
    };
    std::vector<double> radius;
    for (std::size_t v = 0; v < ball.size(); ++v)
      radius.push_back((v < little ? 1 : 0.1) * ball[v] * std::sqrt(wide(places[v]).x));
    std::vector<std::vector<LimbFork>> parts(places.size());
    for (const LimbFork& fork : forks) parts[0].push_back(fork);
    std::vector<std::uint32_t> of(places.size(), kNone);
    for (std::uint32_t v = 0; v < of_hub; ++v) of[v] = 0;
    return places[limb_tubes({places, lines(), ball, radius, parts, {hubs, of}, ellipse})(at, from)];
  }
};

// A trunk of radius 2 along z, and an arm of 0.5 along x from its middle, where the largest ball is wider.
Tubed trunk_and_arm() {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 2.2);
  lines.go(joint, {0, 0, 0.1}, 100, 2);
  lines.go(joint, {0, 0, -0.1}, 100, 2);
  lines.go(joint, {0.1, 0, 0}, 100, 0.5);
  for (std::size_t v = 1; v <= 5; ++v) lines.ball[v] = 2.2;
  return lines;
}

TEST(LimbTubes, AnArmBeginsAtTheTubeOfItsTrunk) {
  const Tubed lines = trunk_and_arm();
  for (const double z : {-0.3, 0., 0.2}) {
    EXPECT_EQ(lines.owner({1.97, 0, z}).x, 0) << z;
    EXPECT_GT(lines.owner({2.03, 0, z}).x, 1) << z << ": the ball about the joint is wider than the trunk";
  }
}

// At the joint of the legs, outside of the trunk's tube: nearer to the hand, but not where the arm meets the trunk.
TEST(LimbTubes, AHandAtAHipHasNothingOfThat) {
  Tubed lines;
  const std::uint32_t shoulder = lines.add({0, 0, 0}, 1.1);
  lines.go(shoulder, {0, 0, 0.1}, 30, 0.5);
  const std::uint32_t hips = lines.go(shoulder, {0, 0, -0.1}, 50, 1);
  for (const double side : {-0.03, 0.03}) lines.go(hips, {side, 0, -0.1}, 60, 0.8);
  const std::uint32_t elbow = lines.go(lines.go(shoulder, {0.1, 0, 0}, 40, 0.3), {0, 0, -0.1}, 50, 0.3);
  lines.go(elbow, {-0.1, 0, 0}, 25, 0.3);
  const Vec3 owner = lines.owner({1.15, 0, -4.9}, hips - 1);
  EXPECT_LT(owner.x, 0.5);
  EXPECT_NEAR(owner.z, -5, 0.5);
}

// What is nearest to the ridge under a tail's root may lie far along the back, beyond the trunk's tube.
TEST(LimbTubes, ATailHasNothingOfTheBack) {
  Tubed lines;
  const std::uint32_t root = lines.add({0, 0, 0}, 1.1);
  lines.go(root, {0.1, 0, 0}, 100, 1);
  lines.go(root, {0, 0, -0.1}, 40, 0.5);
  const std::uint32_t first = lines.go(root, {-0.07, 0, 0.07}, 1, 0.4);
  lines.go(first, {-0.07, 0, 0.07}, 40, 0.4);
  const Vec3 owner = lines.owner({5, 0, 1.02}, first);
  EXPECT_NEAR(owner.x, 5, 0.1);
}

// A chest is twice as wide as deep.
TEST(LimbTubes, AnArmBeginsAtTheSideOfAFlatTrunk) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 1.1);
  lines.go(joint, {0, 0, 0.1}, 100, 1);
  lines.go(joint, {0, 0, -0.1}, 100, 1);
  lines.go(joint, {0.1, 0, 0}, 100, 0.5);
  lines.wide = [](const Vec3& place) { return Vec3{place.x == 0 ? 2. : 1., 1, 1}; };
  for (const double z : {-0.4, 0., 0.4}) {
    EXPECT_EQ(lines.owner({1.97, 0, z}).x, 0) << z;
    EXPECT_GT(lines.owner({2.03, 0, z}).x, 1) << z;
    const double side = 2 * std::sqrt(1 - 0.3 * 0.3);
    EXPECT_EQ(lines.owner({side - 0.03, 0.3, z}).x, 0) << z;
    EXPECT_GT(lines.owner({side + 0.03, 0.3, z}).x, 1) << z;
  }
}

// A flat neck, and a leg thinner than that: what lies on the far side of the joint is no neck.
TEST(LimbTubes, OnlyTheThickestGoesOnBeyondItsJoint) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 1);
  lines.go(joint, {-0.1, 0, 0}, 100, 1);
  lines.go(joint, {0, 0, 0.1}, 100, 0.5);
  lines.go(joint, {0.1, 0, 0}, 100, 0.3);
  lines.wide = [](const Vec3& place) { return Vec3{place.z > 0 ? 2.6 : 1., 1, 1}; };
  EXPECT_GT(lines.owner({1.2, 0, 0.28}).z, 0);
  EXPECT_GT(lines.owner({1.2, 0, -0.2}).x, 1);
  EXPECT_LE(lines.owner({0.8, 0, -0.2}).x, 0) << "the thickest does";
}

TEST(LimbTubes, ATrunkEndsInARoundEndWhereItsLimbsBegin) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 1.3);
  lines.go(joint, {0, 0, -0.1}, 80, 1);
  lines.go(joint, {0.08, 0, 0.06}, 80, 0.5);
  lines.go(joint, {-0.08, 0, 0.06}, 80, 0.5);
  for (const double side : {-1., 1.}) {
    EXPECT_LT(lines.owner({0.95 * 0.8 * side, 0, 0.95 * 0.6}).z, 0.001);
    EXPECT_GT(lines.owner({1.05 * 0.8 * side, 0, 1.05 * 0.6}).x * side, 0.5);
  }
}

// However thick the trunk: a neck between shoulders begins where they part from it.
TEST(LimbTubes, ATrunkEndsWhereTheLimbsBeyondPart) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 0.5);
  lines.go(joint, {0, 0, -0.1}, 80, 1);
  lines.go(joint, {0, 0, 0.1}, 80, 0.5);
  lines.go(joint, {0.1, 0, 0}, 80, 0.5);
  EXPECT_LT(lines.owner({0, 0, 0.95}).z, 0.01) << "no fork is known";
  const auto fork = [&](double height) -> LimbFork { return {{{{1, false}, {2, false}}}, {0.5, 0, height}}; };
  for (const double height : {0.3, 0.6}) {
    lines.forks = {fork(height)};
    const double end = height / std::sqrt(1 - 0.25);
    EXPECT_LT(lines.owner({0, 0, end - 0.03}).z, 0.01) << height;
    EXPECT_GT(lines.owner({0, 0, end + 0.03}).z, 0.01) << height;
  }
}

// Nor is it narrower there where the joint's ball is.
TEST(LimbTubes, ATrunkIsAsWideInAJointAsBelow) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 0.5);
  lines.go(joint, {0, 0, -0.1}, 80, 1);
  lines.go(joint, {0, 0, 0.1}, 80, 0.4);
  lines.go(joint, {0.1, 0, 0}, 80, 0.4);
  for (std::size_t v = 1; v < 5; ++v) lines.ball[v] = 0.6;
  for (const double z : {-0.05, -0.3}) {
    EXPECT_LT(lines.owner({0.95, 0, z}).x, 0.5) << z;
    EXPECT_GT(lines.owner({1.05, 0, z}).x, 0.5) << z;
  }
}

// The link is the thickest of all, and has no vertex that is no joint.
TEST(LimbTubes, ALinkOfTwoJointsHasNothing) {
  Tubed lines;
  const std::uint32_t one = lines.add({0, 0, 0}, 0.6), other = lines.add({0.1, 0, 0}, 0.6);
  lines.segments.push_back({one, other});
  for (const double side : {-1., 1.}) {
    lines.go(one, {-0.1, 0.1 * side, 0}, 60, 0.5);
    lines.go(other, {0.1, 0.1 * side, 0}, 60, 0.5);
  }
  for (const Vec3& at : lines.places) EXPECT_GT(norm(lines.owner(at) - Vec3{0.05, 0, 0}), 0.06);
}

// A flat body, under which the line runs from leg to leg: each begins where it leaves the body.
TEST(LimbTubes, AHubHasItsEllipsoid) {
  Tubed lines;
  const std::uint32_t body = lines.add({0, 0, 0}, 0.7);
  const std::uint32_t other = lines.go(body, {0.1, 0, 0}, 4, 0.7);
  const Vec3 step[] = {{0.1, 0, 0}, {0, 0.1, 0}, {-0.1, 0, 0}, {0, -0.1, 0}};
  std::vector<std::uint32_t> roots;
  for (const Vec3& way : step) roots.push_back(lines.go(way.x + way.y > 0 ? other : body, way, 10, 0.7));
  lines.of_hub = static_cast<std::uint32_t>(lines.places.size());
  for (std::size_t n = 0; n < 4; ++n) lines.go(roots[n], step[n], 60, 0.5);
  const Vec3 above{0.2, 0, 1};
  lines.hubs = {{{above, {{{0.25, 0, 0}, {0, 0.25, 0}, {0, 0, 1}}}}, body}};  // 2 wide, 1 high
  EXPECT_EQ(lines.owner({0.2, 0, 1.95}), lines.places[body]);
  EXPECT_EQ(lines.owner({1.5, 1, 1.3}), lines.places[body]) << "nearer to a leg's line";
  EXPECT_EQ(lines.owner({0.2, 0.2, -0.3}), lines.places[body]) << "under it, nearest to its lines";
  EXPECT_EQ(lines.owner({2.05, 0, 0.9}), lines.places[body]) << "within it, above a leg";
  const Vec3 leg = lines.owner({2.2, 0, 0.45});
  EXPECT_GT(leg.x, 2) << "outside it";
  EXPECT_LT(norm(lines.owner({4, 0.1, 0.1}) - Vec3{4, 0, 0}), 1e-9);
  EXPECT_GT(lines.owner({1.3, 0, -0.1}).x, 1.4) << "nearest to the hub's own line, and to a leg's tube";
}

// An arm of a starfish, 2 thick where it begins in a ball of 3 and 0.5 at its end, is thicker beside the ball than mostly.
TEST(LimbTubes, ATaperedLimbHasNoRingOfItsHub) {
  Tubed lines;
  const std::uint32_t body = lines.add({0, 0, 0}, 3);
  std::uint32_t last = lines.go(body, {0.1, 0, 0}, 24, 2);
  lines.of_hub = last + 1;
  for (int n = 0; n < 80; ++n) last = lines.go(last, {0.1, 0, 0}, 1, 2 - 1.5 * n / 80);
  lines.hubs = {{{{}, {{{1. / 9, 0, 0}, {0, 1. / 9, 0}, {0, 0, 1. / 9}}}}, body}};
  for (const double off : {1.2, 1.4, 1.6, 1.85})
    EXPECT_NEAR(lines.owner({2.65, 0, off}).x, 2.65, 0.06) << off;
}

// A leg under the corner of a seat: what lies above it is the seat's, though the ellipsoid does not reach it.
TEST(LimbTubes, ALegDoesNotGoOnIntoItsHub) {
  Tubed lines;
  const std::uint32_t body = lines.add({0, 0, 0}, 1);
  const std::uint32_t above = lines.go(body, {0.2, 0, 0}, 15, 1);
  lines.of_hub = above + 1;
  lines.go(above, {0, 0, -0.1}, 60, 0.6);
  lines.hubs = {{{{}, {{{1. / 9.2, 0, 0}, {0, 1. / 9.2, 0}, {0, 0, 9}}}}, body}};  // up to there, flat
  EXPECT_EQ(lines.owner({3.2, 0, 0.3}, above + 1), lines.places[body]);
  EXPECT_LT(lines.owner({3.2, 0, -0.4}).z, -0.1) << "the leg's";
}

TEST(LimbTubes, LimbsAboutAsThickShareTheirJointEvenly) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 1.3);
  const double thick[] = {1, 1.05, 1, 1.05};
  const Vec3 step[] = {{0.1, 0, 0}, {0, 0.1, 0}, {-0.1, 0, 0}, {0, -0.1, 0}};
  for (std::size_t n = 0; n < 4; ++n) lines.go(joint, step[n], 80, thick[n]);
  for (const Vec3& way : step) {
    const Vec3 owner = lines.owner(0.3 * way);  // nearest to the joint itself
    EXPECT_GT(dot(owner, way), 0) << "a joint has nothing";
    EXPECT_EQ(lines.owner(5 * way + Vec3{0.01, 0.02, 0}), 5 * way);
  }
}

// Of the two halves of a bar, about as thick, neither has all that an arm leaves, nor what a walk along the arm came to.
TEST(LimbTubes, TheHalvesOfABarShareWhatAnArmLeaves) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 1);
  for (const double x : {0.1, -0.1}) lines.go(joint, {x, 0, 0}, 80, 1);
  lines.go(joint, {0, 0.1, 0}, 60, 0.6);
  const std::uint32_t arm = lines.nearest({0, 0.5, 0});
  for (const double x : {0.2, 0.4, -0.2, -0.4})
    EXPECT_GT(lines.owner({x, 0.5, 0.1}, arm).x * x, 0) << x << ", in the tubes of both halves";
  for (const double x : {0.3, -0.3}) {
    const std::uint32_t other = lines.nearest({-x, 0, 0});
    EXPECT_GT(lines.owner({x, -0.2, 0}, other).x * x, 0) << x << ", nearest to the other half, they said";
  }
}

// Noise makes loops within a body's hips: as wide as these are, they have little of them for their length.
TEST(LimbTubes, ALoopOfLittleVolumeIsThinHoweverWideItsBalls) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 2);
  lines.go(joint, {0, 0, 0.1}, 60, 2);
  lines.go(joint, {0.04, 0, -0.1}, 100, 1);
  lines.go(joint, {-0.04, 0, -0.1}, 100, 1);
  const std::uint32_t back = lines.go(joint, {0, 0.1, -0.1}, 20, 1.5);
  const std::uint32_t low = lines.go(back, {0, 0, -0.1}, 5, 1.5);
  lines.join(lines.go(low, {0, -0.0769, 0.0923}, 25, 1.5), joint);
  lines.little = lines.places.size() - 50;
  EXPECT_GT(lines.owner({0.3, 0, -2.05}).x, 0.3) << "in the leg's tube, and the loop's";
  const std::uint32_t leg = lines.nearest({0.68, 0, -1.7});
  EXPECT_EQ(lines.owner({0.3, 1.2, -1.7}, leg).y, 0) << "nearest to the leg, in the loop's tube alone";
}

// The limb that one hangs on is as thick as it is beyond the joint, however its line ends there.
TEST(LimbTubes, ALinkWithinALongerLimbHasNothing) {
  for (const double side : {0.5, 3.}) {
    Tubed lines;
    const std::uint32_t top = lines.add({0, 0, 0}, 2);
    lines.go(top, {0, 0, -0.1}, 100, 2);
    lines.go(top, {-0.1, 0, 0}, 60, 0.7);
    const std::uint32_t fork = lines.go(top, {0.1, 0, 0}, static_cast<int>(10 * side), 1.95);
    for (const double y : {-0.1, 0.1}) lines.go(fork, {0, y, 0}, 60, 0.5);
    const Vec3 owner = lines.owner({0.6 * side, 0, 0.3});
    EXPECT_EQ(owner.x == 0, side < 2) << side;
  }
}

}  // namespace
}  // namespace affskel::core

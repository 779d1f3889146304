#include "core/curve/limb_tubes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace affskel::core {
namespace {

// Tubed from a place outwards, in steps.
struct Tubed {
  std::vector<Vec3> places;
  std::vector<Segment> segments;
  std::vector<double> ball;

  std::uint32_t add(const Vec3& at, double thick) {
    places.push_back(at);
    ball.push_back(thick);
    return static_cast<std::uint32_t>(places.size() - 1);
  }
  // @returns the last vertex.
  std::uint32_t go(std::uint32_t from, const Vec3& step, int steps, double thick) {
    for (int n = 0; n < steps; ++n) {
      const std::uint32_t to = add(places[from] + step, thick);
      segments.push_back({from, to});
      from = to;
    }
    return from;
  }
  std::uint32_t nearest(const Vec3& at) const {
    std::uint32_t best = 0;
    for (std::uint32_t v = 0; v < places.size(); ++v)
      if (norm(places[v] - at) < norm(places[best] - at)) best = v;
    return best;
  }
  Vec3 owner(const Vec3& at) const {
    return places[LimbTubes(places, segments, ball, ball).vertex_of(at, nearest(at))];
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

// The link is the thickest of all, and has no vertex that is no joint.
TEST(LimbTubes, ALinkOfTwoJointsHasNothing) {
  Tubed lines;
  const std::uint32_t one = lines.add({0, 0, 0}, 3), other = lines.add({0.1, 0, 0}, 3);
  lines.segments.push_back({one, other});
  for (const double side : {-1., 1.}) {
    lines.go(one, {-0.1, 0.1 * side, 0}, 60, 0.5);
    lines.go(other, {0.1, 0.1 * side, 0}, 60, 0.5);
  }
  for (const Vec3& at : lines.places) EXPECT_GT(norm(lines.owner(at) - Vec3{0.05, 0, 0}), 0.06);
}

TEST(LimbTubes, LimbsAboutAsThickShareTheirJointEvenly) {
  Tubed lines;
  const std::uint32_t joint = lines.add({0, 0, 0}, 1.5);
  const double thick[] = {1, 1.05, 1, 1.05};
  const Vec3 step[] = {{0.1, 0, 0}, {0, 0.1, 0}, {-0.1, 0, 0}, {0, -0.1, 0}};
  for (std::size_t n = 0; n < 4; ++n) lines.go(joint, step[n], 80, thick[n]);
  for (const Vec3& way : step) {
    const Vec3 owner = lines.owner(0.3 * way);  // nearest to the joint itself
    EXPECT_GT(dot(owner, way), 0) << "a joint has nothing";
    EXPECT_EQ(lines.owner(5 * way + Vec3{0.01, 0.02, 0}), 5 * way);
  }
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

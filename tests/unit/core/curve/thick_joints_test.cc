#include "core/curve/thick_joints.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/curve/drawn_lines.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Limbs of radius 0.5 along y from joints on the x axis, in balls of 2, and of `between` on the link.
struct Body : DrawnLines {
  std::vector<std::uint32_t> hips;
  std::vector<std::vector<std::uint32_t>> lines;
  std::vector<JointBalls> joints;

  explicit Body(double length, double between = 2) {
    const std::uint32_t hip = add({0, 0, 0}, 2);
    hips = {hip, go(hip, {0.1, 0, 0}, static_cast<int>(10 * length), between)};
    ball[hips[1]] = 2;
    for (const std::uint32_t at : hips)
      for (const double side : {-0.1, 0.1}) go(at, {0, side, 0}, 60, 0.5);
    lines = polylines(places.size(), segments);
  }

  std::vector<std::uint32_t> thick(double of_limbs, double of_link) {
    std::vector<double> size;
    for (const auto& line : lines) size.push_back(places[line[1]].y == 0 ? of_link : of_limbs);
    joints = joint_balls(places, lines, ball);
    return thick_joints(places, lines, size, joints);
  }
};

TEST(ThickJoints, AreThickerThanAllThatMeetsThere) {
  Body body(6);
  EXPECT_EQ(body.thick(0.5, 0.5)[body.hips[0]], body.hips[0]);
  EXPECT_EQ(body.thick(0.5, 0.5)[body.hips[1]], body.hips[1]);
  EXPECT_EQ(body.thick(0.5, 1.9)[body.hips[0]], kNoThickJoint) << "the link is its trunk";
  EXPECT_EQ(body.thick(1.9, 0.5)[body.hips[0]], kNoThickJoint);
  EXPECT_EQ(body.thick(0.5, 0.5)[1], kNoThickJoint) << "no joint";
}

TEST(ThickJoints, AreOneAcrossALinkInTheirBalls) {
  Body body(3);
  const auto thick = body.thick(0.5, 1.9);
  EXPECT_EQ(thick[body.hips[0]], body.hips[0]);
  EXPECT_EQ(thick[body.hips[1]], body.hips[0]);
  EXPECT_LT(body.joints[body.hips[0]].outside({4.9, 0, 0}, 1), 0) << "has the balls of both";
  EXPECT_EQ(Body(5).thick(0.5, 1.9)[0], kNoThickJoint) << "longer than both balls";
}

// Hips at the side of a trunk, whose balls hold them.
TEST(ThickJoints, AreNotBesideAThickerLimb) {
  Body body(1, 0.6);
  const std::uint32_t trunk = body.hips[1];
  body.go(trunk, {0, 0, 0.1}, 90, 2);
  body.lines = polylines(body.places.size(), body.segments);
  std::vector<double> size;
  for (const auto& line : body.lines) size.push_back(body.ball[line[line.size() / 2]]);
  body.joints = joint_balls(body.places, body.lines, body.ball);
  EXPECT_EQ(thick_joints(body.places, body.lines, size, body.joints)[body.hips[0]], kNoThickJoint);
}

}  // namespace
}  // namespace affskel::core

#include "core/curve/limb_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace affskel::core {
namespace {

// A trunk along z of radius 1, and a limb from its middle along a unit direction, whose line sags within the trunk; the
// joint is `off` along the trunk.
struct Tee {
  std::vector<Vec3> places;
  std::vector<Segment> segments;
  std::vector<double> ball;
  std::uint32_t joint = 0;

  Tee(const Vec3& direction, double off) {
    for (int n = -50; n <= 50; ++n) places.push_back({0, 0, 0.1 * n});
    for (std::uint32_t n = 0; n + 1 < places.size(); ++n) segments.push_back({n, n + 1});
    joint = static_cast<std::uint32_t>(50 + std::lround(10 * off));
    std::uint32_t before = joint;
    for (int n = 1; n <= 50; ++n) {
      const double way = 0.1 * n;
      segments.push_back({before, static_cast<std::uint32_t>(places.size())});
      before = segments.back()[1];
      places.push_back(way * direction + Vec3{0, 0, off * std::max(0.0, 1 - way)});
    }
    ball.assign(places.size(), 1);
  }
};

TEST(LimbJoints, AreWhereTheAxesMeet) {
  const Tee tee({0.8, 0, 0.6}, 0.6);
  const std::vector<Vec3> moved = limb_joints(tee.segments, tee.ball, tee.places);
  EXPECT_LT(norm(moved[tee.joint]), 0.05);
  // The limb's line is straight, and so is the trunk's.
  for (std::uint32_t v = 0; v < moved.size(); ++v) {
    const double along = v > 100 ? dot(moved[v], {0.8, 0, 0.6}) : moved[v].z;
    const Vec3 axis = v > 100 ? Vec3{0.8, 0, 0.6} : Vec3{0, 0, 1};
    EXPECT_LT(norm(moved[v] - along * axis), 0.05) << v;
  }
  EXPECT_EQ(moved.back(), tee.places.back());
  EXPECT_EQ(moved.front(), tee.places.front());
}

// Where the axes meet outside the ball about the joint, it stays; and lines without a joint do.
TEST(LimbJoints, StayInTheBall) {
  for (const double radius : {0.05, 0.1, 0.2, 0.3}) {
    Tee thin({0.8, 0, 0.6}, 0.6);
    for (double& ball : thin.ball) ball = radius;
    const std::vector<Vec3> moved = limb_joints(thin.segments, thin.ball, thin.places);
    EXPECT_LT(norm(moved[thin.joint] - thin.places[thin.joint]), radius);
  }
  const std::vector<Vec3> line{{0, 0, 0}, {1, 0.5, 0}, {2, 0, 0}};
  EXPECT_EQ(limb_joints(std::vector<Segment>{{0, 1}, {1, 2}}, std::vector<double>{1, 1, 1}, line), line);
}

}  // namespace
}  // namespace affskel::core

#include "core/curve/joint_balls.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace affskel::core {
namespace {

using Polylines = std::vector<std::vector<std::uint32_t>>;

// A trunk's balls shrink towards the joint, where its neck and an arm begin.
struct Trunk {
  std::vector<Vec3> places{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 4}, {1, 0, 3}};
  std::vector<double> ball{9, 2, 1.5, 0.7, 0.5, 0.4};
  JointBalls joint = joint_balls(places, Polylines{{0, 1, 2, 3}, {3, 4}, {3, 5}}, ball)[3];
};

TEST(JointBalls, AreAsLargeAsTheLargestThatHoldsTheJoint) {
  // That of vertex 1 ends short of the joint, 2 away, and hides 0's.
  EXPECT_EQ(Trunk().joint.size, 1.5);
}

TEST(JointBalls, OfAJointWithTheLargestItsOwn) {
  const std::vector<Vec3> places{{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
  const std::vector<double> ball{1.2, 1.1, 1, 0.9};
  const Polylines lines{{0, 1}, {0, 2}, {3, 0}};
  EXPECT_EQ(joint_balls(places, lines, ball)[0].size, 1.2);
}

TEST(JointBalls, LookBothWaysAlongALine) {
  const std::vector<Vec3> places{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<double> ball{0.5, 2, 0.5};
  for (const JointBalls& joint : joint_balls(places, Polylines{{0, 1, 2}}, ball)) EXPECT_EQ(joint.size, 2);
}

// As near to the joint as the largest ball is large, but beside the neck: a handle that comes back to the trunk.
TEST(JointBalls, HoldWhatLiesInThem) {
  const JointBalls joint = Trunk().joint;
  EXPECT_TRUE(joint.hold({1, 0, 2})) << "in the largest";
  EXPECT_TRUE(joint.hold({1.2, 0, 3.2})) << "in the largest, made larger";
  EXPECT_TRUE(joint.hold({0.8, 0, 3})) << "in the joint's own, made larger";
  EXPECT_FALSE(joint.hold({1.2, 0, 3.8}));
  EXPECT_FALSE(joint.hold({0, 0, 0.7})) << "in the largest, but farther from the joint than that is large";
}

}  // namespace
}  // namespace affskel::core

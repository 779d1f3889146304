#include "core/curve/joint_sizes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace affskel::core {
namespace {

using Polylines = std::vector<std::vector<std::uint32_t>>;

// A trunk's balls shrink towards the joint, where its neck and an arm begin.
TEST(JointSizes, AreOfTheLargestBallThatHoldsTheJoint) {
  const std::vector<Vec3> places{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}, {0, 0, 4}, {1, 0, 3}};
  const std::vector<double> ball{9, 2, 1.5, 0.7, 0.5, 0.4};
  const Polylines lines{{0, 1, 2, 3}, {3, 4}, {3, 5}};
  // That of vertex 1 ends short of the joint, 2 away, and hides 0's.
  EXPECT_EQ(joint_sizes(places, lines, ball)[3], 1.5);
}

TEST(JointSizes, OfAJointWithTheLargestBallItsOwn) {
  const std::vector<Vec3> places{{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}};
  const std::vector<double> ball{1.2, 1.1, 1, 0.9};
  const Polylines lines{{0, 1}, {0, 2}, {3, 0}};
  EXPECT_EQ(joint_sizes(places, lines, ball)[0], 1.2);
}

TEST(JointSizes, LookBothWaysAlongALine) {
  const std::vector<Vec3> places{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
  const std::vector<double> ball{0.5, 2, 0.5};
  const std::vector<double> size = joint_sizes(places, Polylines{{0, 1, 2}}, ball);
  EXPECT_EQ(size, (std::vector<double>{2, 2, 2}));
}

}  // namespace
}  // namespace affskel::core

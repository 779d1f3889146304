#include "core/curve/limb_forks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/curve/drawn_lines.h"
#include "core/curve/tubes.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

// Two legs and a trunk.
struct Forked : DrawnLines {
  std::vector<std::vector<std::uint32_t>> lines;
  std::vector<std::vector<LimbFork>> forks;

  explicit Forked(double slant, double top = 0) {
    const std::uint32_t joint = add({0, 0, top}, 1);
    go(joint, {0, 0, 0.1}, static_cast<int>(std::lround((3 - top) / 0.1)), 1);
    for (const double side : {-1., 1.}) {
      const Vec3 foot{6 * side * std::sin(slant), 0, -6 * std::cos(slant)};
      go(joint, (1. / 60) * (foot - places[joint]), 60, 0.5);
    }
    const std::vector<Tube> tubes{{{0, 0, 0}, {0, 0, 3}, 0.8},
                                  {{0, 0, 0}, {-6 * std::sin(slant), 0, -6 * std::cos(slant)}, 0.5},
                                  {{0, 0, 0}, {6 * std::sin(slant), 0, -6 * std::cos(slant)}, 0.5}};
    const Mesh mesh = tube_mesh(tubes, 0.1);
    lines = polylines(places.size(), segments);
    forks = limb_forks(places, lines, LimbSections(mesh), 0.1);
  }
  std::vector<LimbFork> of_legs() const {
    std::vector<LimbFork> result;
    for (const LimbFork& fork : forks[0])
      if (fork.place.z < -0.5 && std::abs(fork.place.x) < 0.1) result.push_back(fork);
    return result;
  }
};

TEST(LimbForks, TwoLegsPartInTheCrotch) {
  const double slant = 0.3;
  const Forked body(slant);
  const auto legs = body.of_legs();
  ASSERT_EQ(legs.size(), 1U);
  EXPECT_NEAR(legs[0].place.x, 0, 0.02);
  EXPECT_NEAR(legs[0].place.z, -0.5 / std::sin(slant), 0.1);  // the mesh's edges
  for (const LineEnd& limb : legs[0].limbs) EXPECT_GT(body.lines[limb.line].size(), 50U) << "the trunk";
  EXPECT_NE(legs[0].limbs[0], legs[0].limbs[1]);
}

// A leg's section is its own from where it has passed the crotch.
TEST(LimbForks, ALegIsInItsJointUpToThere) {
  const double slant = 0.3;
  const Forked body(slant);
  const auto legs = body.of_legs();
  ASSERT_EQ(legs.size(), 1U);
  for (const LineEnd& leg : legs[0].limbs) {
    const std::size_t count = before_forks(body.places, body.lines, body.forks[0], leg);
    const double along = 0.5 / std::sin(slant) * std::cos(slant);
    EXPECT_NEAR(0.1 * static_cast<double>(count), along, 0.2);
    EXPECT_EQ(before_forks(body.places, body.lines, {}, leg), 0U);
  }
}

TEST(LimbForks, ThatPlaceStaysWhereTheJointMoves) {
  const double slant = 0.3, before = Forked(slant).of_legs().at(0).place.z;
  for (const double top : {0.3, 0.6}) {
    const auto legs = Forked(slant, top).of_legs();
    ASSERT_EQ(legs.size(), 1U) << top;
    EXPECT_NEAR(legs[0].place.z, before, 0.01) << top;
  }
}

// A trunk and a leg that goes straight on see each other all the way.
TEST(LimbForks, LimbsInOneTubeDoNotPart) {
  const Forked body(0.3);
  for (std::size_t v = 1; v < body.forks.size(); ++v) EXPECT_TRUE(body.forks[v].empty()) << "no joint";
  DrawnLines line;
  const std::uint32_t joint = line.add({0, 0, 0}, 1);
  for (const Vec3& step : {Vec3{0, 0, 0.1}, Vec3{0, 0, -0.1}, Vec3{0.01, 0, 0.1}})
    line.go(joint, step, 20, 1);
  const std::vector<Tube> tubes{{{0, 0, -3}, {0, 0, 3}, 1}};
  const Mesh mesh = tube_mesh(tubes, 0.1);
  const auto forks =
      limb_forks(line.places, polylines(line.places.size(), line.segments), LimbSections(mesh), 0.1);
  EXPECT_TRUE(forks[joint].empty());
}

TEST(LimbForks, AheadIsWithin60Degrees) {
  EXPECT_DOUBLE_EQ(ahead({0, 0, 2}, {0, 0, 1}), 0.75);
  EXPECT_DOUBLE_EQ(ahead({0, 0, -2}, {0, 0, 1}), 0.75);
  EXPECT_GT(ahead({1.7, 0, 1}, {0, 0, 1}), 0);
  EXPECT_EQ(ahead({1.74, 0, 1}, {0, 0, 1}), 0);
}

}  // namespace
}  // namespace affskel::core

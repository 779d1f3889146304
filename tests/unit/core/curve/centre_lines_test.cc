#include "core/curve/centre_lines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/base/unit.h"
#include "core/curve/drawn_lines.h"
#include "core/curve/tubes.h"
#include "core/solid/solid_membership.h"

namespace affskel::core {
namespace {

// A zigzag of legs a few segments long, which averages of neighbours cut short.
TEST(CentreLines, NoVertexLeavesAZigzag) {
  constexpr double kRadius = 0.08, kSpacing = 0.1;
  std::vector<Vec3> corners;
  for (int n = 0; n < 8; ++n) corners.push_back({0.3 * n, n % 2 == 0 ? 0. : 0.4, 0});
  std::vector<Tube> tubes;
  for (std::size_t n = 1; n < corners.size(); ++n) tubes.push_back({corners[n - 1], corners[n], kRadius});
  const LimbSurface surface(tube_mesh(tubes, 0.04));
  std::vector<Vec3> places;
  std::vector<Segment> segments;
  for (const Tube& tube : tubes) {
    const double length = norm(tube.to - tube.from);
    for (double way = 0; way < length; way += kSpacing)
      places.push_back(tube.from + (way / length) * (tube.to - tube.from) + Vec3{0, 0, 0.7 * kRadius});
  }
  for (std::uint32_t v = 1; v < places.size(); ++v) segments.push_back({v - 1, v});
  const std::vector<Vec3> before = places, tip(places.size());
  const std::vector<char> has_tip(places.size(), 0);
  centre_lines(
      {.surface = surface, .segments = segments, .tip = tip, .has_tip = has_tip, .spacing = kSpacing},
      places);
  const SolidMembership solid(surface.mesh);
  double farthest = 0;
  for (std::size_t v = 0; v < places.size(); ++v) {
    ASSERT_TRUE(solid.contains(before[v]));
    EXPECT_TRUE(solid.contains(places[v])) << v;
    farthest = std::max(farthest, norm(places[v] - before[v]));
  }
  EXPECT_GT(farthest, 0.5 * kRadius) << "they go to the middle";
}

// Waves about as long as a limb is thick, which neither means over as much nor fixed passes of neighbours smooth.
TEST(CentreLines, OfAThickTubeAreItsAxisWhateverTheyBeganAs) {
  constexpr double kRadius = 1.2, kSpacing = 0.1;
  const LimbSurface surface(tube_mesh(std::vector<Tube>{{{0, 0, 0}, {0, 0, 9}, kRadius}}, 0.2));
  for (const double wave : {1.1, 1.3, 1.6}) {
    std::vector<Vec3> places;
    std::vector<Segment> segments;
    for (double z = 0; z <= 9; z += kSpacing)
      places.push_back({0.08 * std::sin(2 * std::numbers::pi * z / wave), 0, z});
    for (std::uint32_t v = 1; v < places.size(); ++v) segments.push_back({v - 1, v});
    const std::vector<Vec3> tip(places.size());
    const std::vector<char> has_tip(places.size(), 0);
    centre_lines(
        {.surface = surface, .segments = segments, .tip = tip, .has_tip = has_tip, .spacing = kSpacing},
        places);
    double farthest = 0;
    for (const Vec3& at : places)
      if (at.z > 1 && at.z < 8) farthest = std::max(farthest, std::hypot(at.x, at.y));
    EXPECT_LT(farthest, 0.2 * kSpacing) << wave;
  }
}

// Lines that are about parallel do not tell where they meet: the crotch does.
TEST(CentreLines, HipsLieAsFarAboveTheCrotchAsLegsAreThickWhereverTheyBegan) {
  constexpr double kSpacing = 0.1, kThick = 0.5, kApart = 0.6;
  const auto foot = [](double side) { return Vec3{kApart * side, 0, -8}; };
  const std::vector<Tube> tubes{
      {{0, 0, 1}, {0, 0, 8}, 1}, {{-kApart, 0, 0.6}, foot(-1), kThick}, {{kApart, 0, 0.6}, foot(1), kThick}};
  const LimbSurface surface(tube_mesh(tubes, 0.1));
  for (const double start : {0.4, 0.8, 1.1}) {
    DrawnLines lines;
    const std::uint32_t joint = lines.add({0, 0, start}, 1);
    lines.go(joint, {0, 0, kSpacing}, static_cast<int>(std::lround((8 - start) / kSpacing)), 1);
    for (const double side : {-1., 1.}) {
      const Vec3 knee{kApart * side, 0, -0.6};
      const std::uint32_t leg = lines.go(joint, (1. / 12) * (knee - lines.places[joint]), 12, kThick);
      lines.go(leg, {0, 0, -kSpacing}, 74, kThick);
    }
    const std::vector<Vec3> tip(lines.places.size());
    const std::vector<char> has_tip(lines.places.size(), 0);
    centre_lines(
        {.surface = surface, .segments = lines.segments, .tip = tip, .has_tip = has_tip, .spacing = kSpacing},
        lines.places);
    EXPECT_NEAR(lines.places[joint].z, kThick, 2 * kSpacing) << start << ": the crotch is at 0";
    EXPECT_NEAR(lines.places[joint].x, 0, 0.2 * kSpacing) << start;
  }
}

// A foot, twice as long as thick, at the end of a leg.
TEST(CentreLines, EndAlongTheFootNotTheLeg) {
  constexpr double kSpacing = 0.25;
  const Vec3 hip{0, 0, 9}, ankle{0, 0, 0}, toe{2.2, 0, -0.8};
  const LimbSurface surface(tube_mesh(std::vector<Tube>{{hip, ankle, 1}, {ankle, toe, 1}}, 0.2));
  std::vector<Vec3> places;
  std::vector<Segment> segments;
  const auto add = [&](const Vec3& from, const Vec3& to) {
    for (double way = 0; way < norm(to - from); way += kSpacing)
      places.push_back(from + (way / norm(to - from)) * (to - from));
  };
  add(hip, ankle);
  add(ankle, toe);
  for (std::uint32_t v = 1; v < places.size(); ++v) segments.push_back({v - 1, v});
  const std::vector<Vec3> tip(places.size(), toe);
  std::vector<char> has_tip(places.size(), 0);
  has_tip.back() = 1;
  centre_lines(
      {.surface = surface, .segments = segments, .tip = tip, .has_tip = has_tip, .spacing = kSpacing},
      places);
  const Vec3 end = unit(places.back() - places[places.size() - 2]);
  EXPECT_GT(dot(end, unit(toe - ankle)), std::cos(std::numbers::pi / 6));
}

}  // namespace
}  // namespace affskel::core

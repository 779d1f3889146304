#include "core/curve/line_ends.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

#include "core/base/unit.h"
#include "core/curve/tubes.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

constexpr double kSpacing = 0.1;

// A line down the axis from z = 10 to where it ends, whose first vertices turn to a place; drawn again.
std::vector<Vec3> drawn(const Mesh& mesh, double from, const Vec3& to, double low = 2) {
  std::vector<Vec3> places;
  const double turn = from - 0.9;
  for (double part = 0; part < 1; part += 0.05) places.push_back(to + part * (Vec3{0, 0, turn} - to));
  for (double z = turn; z > low; z -= kSpacing) places.push_back({0, 0, z});
  std::vector<std::uint32_t> line(places.size());
  std::iota(line.begin(), line.end(), 0U);
  const LimbSurface surface(mesh);
  draw_end({surface, kSpacing, line, 0, to}, places);
  return places;
}

Mesh bar() {
  Mesh box = make_box(2, 2, 10, 4);
  for (Vec3& p : box.points) p = p - Vec3{1, 1, 0};
  return box;
}

TEST(LineEnds, OfABarIsInItsFace) {
  const Vec3 end = drawn(bar(), 10, {0, 0, 9.05})[0];
  EXPECT_NEAR(end.z, 10, kSpacing);
  EXPECT_LE(end.z, 10) << "within";
}

TEST(LineEnds, ALineThatTurnsToACornerGoesStraightOn) {
  for (const Vec3& place : drawn(bar(), 10, {0.9, 0.9, 9.9}))
    EXPECT_LT(std::hypot(place.x, place.y), 1e-6) << place.z;
  EXPECT_NEAR(drawn(bar(), 10, {0.9, 0.9, 9.9})[0].z, 10, kSpacing);
}

// Five times as wide as thick: the tip lies aside in the end's edge, and the line leads there and on as before.
TEST(LineEnds, OfAPlateIsInTheMiddleOfItsEdge) {
  Mesh plate = make_box(10, 2, 20, 4);
  for (Vec3& p : plate.points) p = p - Vec3{5, 1, 0};
  std::vector<Vec3> places;
  for (double z = 19; z > 0; z -= kSpacing)
    places.push_back({1.8 * std::clamp((z - 16.5) / 1.5, 0.0, 1.0), 0, z});
  std::vector<std::uint32_t> line(places.size());
  std::iota(line.begin(), line.end(), 0U);
  draw_end({LimbSurface(plate), kSpacing, line, 0, {1.8, 0, 19}}, places);
  EXPECT_NEAR(places[0].x, 0, 0.1);
  EXPECT_NEAR(places[0].z, 20, kSpacing);
}

// Of three radii, as an arm of a T that is no longer than wide.
TEST(LineEnds, AShortLineThatTurnsToACornerGoesStraightOn) {
  for (const double length : {3.4, 4.2})
    for (const Vec3& place : drawn(bar(), 10, {0.9, 0.9, 9.9}, 10 - length))
      EXPECT_LT(std::hypot(place.x, place.y), 1e-6) << length << ' ' << place.z;
}

// Within a radius of it, by 24 degrees, as the last lines of a fine lattice do.
TEST(LineEnds, OfALineThatTurnsAsideInAFlatEndIsInTheMiddle) {
  const Vec3 end = drawn(bar(), 10, {0.35, 0, 9.9})[0];
  EXPECT_LT(std::hypot(end.x, end.y), 0.05);
  EXPECT_NEAR(end.z, 10, kSpacing);
}

// On a body as wide as it is long the distance to the surface grows all the way to the joint, and there lines turn.
TEST(LineEnds, ALineThatTurnsInAJointGoesStraightOnBeforeIt) {
  const Mesh cube = make_box(10, 10, 10, 4);
  std::vector<Vec3> places;
  for (double z = 9.5; z > 5.5; z -= kSpacing) places.push_back({5 + 0.5 * std::max(0.0, 7 - z), 5, z});
  std::vector<std::uint32_t> line(places.size());
  std::iota(line.begin(), line.end(), 0U);
  draw_end({LimbSurface(cube), kSpacing, line, 15, {5, 5, 9.5}}, places);
  EXPECT_NEAR(places[0].x, 5, 1e-6);
}

TEST(LineEnds, OfARoundLimbIsTheCentreOfItsEnd) {
  const Mesh tube = tube_mesh(std::vector<Tube>{{{0, 0, 0}, {0, 0, 10}, 1}}, 0.15);
  EXPECT_NEAR(drawn(tube, 10, {0, 0, 10.3})[0].z, 10, kSpacing);
}

// Of 2.5 to 4 radii beyond the corner: the line is in the middle to its end, and straight on from before the corner is the
// wall.
TEST(LineEnds, OfALimbThatTurnsIsTheCentreOfItsEnd) {
  for (const double degrees : {60., 90., 110.})
    for (const double tail : {2.5, 3., 3.5, 4.}) {
      const double turn = degrees * std::numbers::pi / 180;
      const Vec3 corner{0, 0, 6}, way{std::sin(turn), 0, std::cos(turn)}, end = corner + tail * way;
      const Mesh limb = tube_mesh(std::vector<Tube>{{{0, 0, 0}, corner, 1}, {corner, end, 1}}, 0.15);
      std::vector<Vec3> places;
      for (double away = 0; away < tail; away += kSpacing) places.push_back(end - away * way);
      for (double z = corner.z; z > 0; z -= kSpacing) places.push_back({0, 0, z});
      for (int pass = 0; pass < 60; ++pass)  // round the corner, as lines do
        for (std::size_t n = 1; n + 1 < places.size(); ++n)
          places[n] = 0.25 * places[n - 1] + 0.5 * places[n] + 0.25 * places[n + 1];
      std::vector<std::uint32_t> line(places.size());
      std::iota(line.begin(), line.end(), 0U);
      draw_end({LimbSurface(limb), kSpacing, line, 0, end + way}, places);
      EXPECT_LT(norm(places[0] - end), 0.25) << degrees << ' ' << tail;
    }
}

// About a circle of so many radii, from a radius of 1 to the last.
void expect_end_of_bent_limb(double bend, double degrees, double last) {
  std::vector<Vec3> middle{{0, 0, -10}};
  for (double part = 0; part <= 1; part += 1. / 64) {
    const double turn = part * degrees * std::numbers::pi / 180;
    middle.push_back({bend * (1 - std::cos(turn)), 0, bend * std::sin(turn)});
  }
  std::vector<Tube> tubes;
  for (std::size_t n = 0; n + 1 < middle.size(); ++n) {
    const double part = std::max(0.0, (static_cast<double>(n) - 1) / 64);
    tubes.push_back({middle[n], middle[n + 1], 1 + part * (last - 1)});
  }
  std::vector<Vec3> places(middle.rbegin(), middle.rend() - 1);
  for (double z = -kSpacing; z > -9; z -= kSpacing) places.push_back({0, 0, z});
  std::vector<std::uint32_t> line(places.size());
  std::iota(line.begin(), line.end(), 0U);
  const Vec3 end = middle.back(), way = unit(end - middle[middle.size() - 2]);
  draw_end({LimbSurface(tube_mesh(tubes, 0.2)), kSpacing, line, 0, end + way}, places);
  EXPECT_LT(norm(places[0] - end), 0.35) << bend << ' ' << degrees << ' ' << last;
}

// As fingers and horns are: within two radii of its end it turns as far as into a corner.
TEST(LineEnds, OfALimbThatBendsIsTheCentreOfItsEnd) {
  for (const double bend : {4., 5.})
    for (const double degrees : {45., 90., 135.})
      for (const double last : {1., 0.7}) expect_end_of_bent_limb(bend, degrees, last);
}

// It bends and tapers ever faster: straight on from where it is thick is the wall.
TEST(LineEnds, OfABananaIsTheCentreOfItsTip) {
  std::vector<Vec3> places;
  std::vector<Tube> tubes;
  for (double t = 1; t > 0.3; t -= 0.02) {
    places.push_back({4 * std::sin(1.9 * t), 0, -7.75 * std::pow(t, 1.1)});
    const double radius = 0.45 + 0.65 * std::pow(std::sin(std::numbers::pi * (t - 0.05) / 0.95), 0.7);
    if (places.size() > 1) tubes.push_back({places.back(), *(places.end() - 2), radius});
  }
  const Vec3 end = places[0], tip = end + 0.05 * unit(end - places[2]);
  places.insert(places.begin(), {tip, 0.5 * (end + tip)});
  std::vector<std::uint32_t> line(places.size());
  std::iota(line.begin(), line.end(), 0U);
  draw_end({LimbSurface(tube_mesh(tubes, 0.1)), kSpacing, line, 0, tip}, places);
  EXPECT_LT(norm(places[0] - end), 0.35);
}

// A head on a neck: it is no bar.
TEST(LineEnds, ALineTurnsInWhatIsWider) {
  const Mesh head =
      tube_mesh(std::vector<Tube>{{{0, 0, 0}, {0, 0, 10}, 0.5}, {{0, 0, 9.9}, {0, 0, 10}, 1.2}}, 0.15);
  EXPECT_GT(drawn(head, 10, {0.6, 0, 10})[0].x, 0.4);
}

TEST(LineEnds, BeyondItALineBendsOnAsItDoes) {
  std::vector<Vec3> circle;
  for (int n = 0; n < 60; ++n) circle.push_back({10 * std::cos(0.02 * n), 10 * std::sin(0.02 * n), 0});
  std::vector<std::uint32_t> line(circle.size());
  std::iota(line.begin(), line.end(), 0U);
  const Vec3 at_0 = outward(circle, line, 2, 0), beyond = outward(circle, line, 2, 2);
  EXPECT_NEAR(at_0.x, 0, 0.03);
  EXPECT_NEAR(at_0.y, -1, 0.01);
  EXPECT_NEAR(std::asin(-beyond.x), 0.1, 0.05) << "half of the gap on";
  EXPECT_EQ(outward(circle, std::vector<std::uint32_t>{3}, 2, 0), (Vec3{}));
}

// A post that turns into a rail at its top, as a chair's.
TEST(LineEnds, BeyondItALineDoesNotBendByACornerFartherOn) {
  std::vector<Vec3> post;
  for (int n = 0; n < 20; ++n) post.push_back({std::max(0.0, 0.2 * n - 2.2), 0, std::min(2.2, 0.2 * n)});
  std::vector<std::uint32_t> line(post.size());
  std::iota(line.begin(), line.end(), 0U);
  for (const double gap : {0., 1.}) EXPECT_LT(norm(outward(post, line, 1.5, gap) - Vec3{0, 0, -1}), 1e-9);
}

}  // namespace
}  // namespace affskel::core

#include "core/curve/limb_radii.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "core/curve/drawn_lines.h"

namespace affskel::core {
namespace {

using std::numbers::pi;

constexpr std::uint32_t kFirstOfThin = 21, kWide = 5;  // vertices of the second line: the first, and how many

// Three lines of 20 vertices from a joint, as thick as 2, 1 and 1; all of them have their slices, the joint has nothing.
struct ThreeLimbs : DrawnLines {
  std::vector<double> share, slice, tube, area;
  std::vector<char> in_joint;

  ThreeLimbs() {
    const std::uint32_t joint = add({0, 0, 0}, 2);
    go(joint, {0, 0, 1}, 20, 2);
    go(joint, {1, 0, 0}, 20, 1);
    go(joint, {-1, 0, 0}, 20, 1);
    for (const double radius : ball) area.push_back(pi * radius * radius);
    share.assign(places.size(), 0.01);
    share[0] = 0;
    slice = share;
    tube = ball;
    in_joint.assign(places.size(), 0);
  }
  // Sections of the second line's first vertices.
  void widen(double radius) { std::fill_n(area.begin() + kFirstOfThin, kWide, pi * radius * radius); }
  std::vector<double> radii() const {
    return limb_radii({lines(), share, slice, tube, ball, area, in_joint, 100});
  }
};

TEST(LimbRadii, AreThoseOfDiscsAsLarge) {
  const ThreeLimbs limbs;
  const std::vector<double> radius = limbs.radii();
  for (std::size_t v = 1; v < radius.size(); ++v) EXPECT_NEAR(radius[v], limbs.ball[v], 1e-12) << v;
  EXPECT_NEAR(radius[0], (2 + 1 + 1) / 3., 1e-12) << "of its lines the mean";
}

TEST(LimbRadii, WithoutALineIsThatOfTheBall) {
  const std::vector<double> one = {1}, none = {0};
  const std::vector<char> free = {0};
  EXPECT_NEAR(limb_radii({{}, one, one, none, none, none, free, 4. / 3 * pi * 8})[0], 2, 1e-12);
}

TEST(LimbRadii, InAJointAreThoseOfWhereTheLimbComesOut) {
  ThreeLimbs limbs;
  limbs.widen(1.2);
  std::fill_n(limbs.in_joint.begin() + kFirstOfThin, kWide, 1);
  EXPECT_NEAR(limbs.radii()[kFirstOfThin], 1, 1e-12);
  limbs.in_joint.assign(limbs.places.size(), 0);
  EXPECT_GT(limbs.radii()[kFirstOfThin], 1.1) << "or such a limb";
}

TEST(LimbRadii, OfASectionThatIsOpenSayNothing) {
  ThreeLimbs limbs;
  limbs.widen(4);
  EXPECT_NEAR(limbs.radii()[kFirstOfThin], 1, 1e-12);
}

TEST(LimbRadii, InAThickerLimbAreThoseOfWhereALimbComesOut) {
  ThreeLimbs limbs;
  limbs.widen(1.2);
  std::fill_n(limbs.share.begin() + kFirstOfThin, kWide, 0);
  EXPECT_NEAR(limbs.radii()[kFirstOfThin], 1, 1e-12);
}

TEST(LimbRadii, OfALineThatLiesInOthersAreItsTubesOrBalls) {
  ThreeLimbs limbs;
  limbs.ball[kFirstOfThin + 8] = 0.5;
  for (std::uint32_t v = kFirstOfThin; v < kFirstOfThin + 20; ++v) {
    limbs.share[v] = 0;
    limbs.tube[v] = 0.7;
  }
  EXPECT_NEAR(limbs.radii()[kFirstOfThin + 7], 1, 1e-12) << "the ball, of which others have the most";
  EXPECT_NEAR(limbs.radii()[kFirstOfThin + 8], 0.7, 1e-12);
}

// As a vessel between two branches, whose slices are theirs.
TEST(LimbRadii, AreNotThoseOfThinnerTubesThanBalls) {
  ThreeLimbs limbs;
  limbs.widen(1.1);
  std::fill_n(limbs.tube.begin() + kFirstOfThin, 20, 0.7);
  EXPECT_NEAR(limbs.radii()[kFirstOfThin], 1.1, 1e-12) << "1.6 of its tube, 1.1 of its ball";
}

TEST(LimbRadii, OfABodyThatLimbsHangOnAreABalls) {
  ThreeLimbs limbs;
  limbs.share[0] = 0.3;
  EXPECT_NEAR(limbs.radii()[0], std::cbrt(0.75 / pi * 30), 1e-12);
}

TEST(SliceRadii, AreThoseOfTubesWithTheVolume) {
  DrawnLines line;
  line.go(line.add({0, 0, 0}, 0.5), {0, 0, 1}, 20, 0.5);
  const double volume = pi * 0.25 * 21;  // half a segment beyond either end, as a ball reaches
  const std::vector<double> slice(line.places.size(), 1. / 21);
  for (const double radius : slice_radii({line.places, line.lines(), slice, line.ball, volume}))
    EXPECT_NEAR(radius, 0.5, 1e-12);
}

}  // namespace
}  // namespace affskel::core

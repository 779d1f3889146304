#include "core/curve/pruned_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "core/curve/drawn_lines.h"

namespace affskel::core {
namespace {

// A trunk along x with balls of 1 about it.
struct Pruned : DrawnLines {
  std::uint32_t first = add({0, 0, 0}, 1), middle = go(first, {0.5, 0, 0}, 10, 1);
  std::uint32_t last = go(middle, {0.5, 0, 0}, 10, 1);

  // @param greatest where E is.
  SheetLines run(std::uint32_t greatest = 0) const {
    SheetLines lines;
    SheetMesh sheet;
    for (std::uint32_t v = 0; v < places.size(); ++v) {
      lines.vertices.push_back(v);
      sheet.vertices.emplace_back().position = places[v];
      sheet.vertices.back().erosion = v == greatest ? 2 : 1;
    }
    lines.segments = segments;
    return pruned_lines(lines, sheet, ball, 0.1);
  }
};

TEST(PrunedLines, KeepsLoops) {
  Pruned lines;
  const std::uint32_t out = lines.go(lines.middle, {0, 0.5, 0}, 2, 0.2);
  lines.join(lines.go(lines.go(out, {0.5, 0, 0}, 3, 0.2), {0, -0.5, 0}, 1, 0.2), lines.middle + 3);
  EXPECT_EQ(lines.run().segments.size(), lines.segments.size());
}

TEST(PrunedLines, DropsASpurAndKeepsALimb) {
  for (const bool is_limb : {false, true}) {
    Pruned lines;
    const std::size_t trunk = lines.segments.size();
    const int steps = is_limb ? 4 : 3;  // to 2 and 1.5 radii from the trunk's line
    lines.go(lines.middle, {0, 0.5, 0}, steps, 0.3);
    EXPECT_EQ(lines.run().segments.size(), is_limb ? trunk + 4 : trunk);
  }
}

// The condyles of a bone: how far beyond its end's ball they lead, radii; and which of their ends are left, with the bone's.
TEST(PrunedLines, DropsBothOfTwoAlikeAtTheEndOfALineOrNone) {
  struct Case {
    double up, down;
    std::size_t left;
  };
  for (const auto& [up, down, left] :
       {Case{0.5, 0.4, 0}, {0.65, 0.5, 2}, {0.5, 0.2, 1}, {0.65, 0.2, 1}, {-0.1, -0.15, 0}}) {
    Pruned lines;
    const std::size_t bone = lines.segments.size();
    lines.go(lines.last, (1 + up) * Vec3{0.6, 0.8, 0}, 1, 0.8);
    lines.go(lines.last, (1 + down) * Vec3{0.6, -0.8, 0}, 1, 0.8);
    EXPECT_EQ(lines.run().segments.size(), bone + left) << up << " " << down;
  }
}

// Its end lies in the trunk's ball.
TEST(PrunedLines, KeepsALimbThatComesBack) {
  for (const int steps : {2, 6}) {
    Pruned lines;
    const std::size_t trunk = lines.segments.size();
    const std::uint32_t elbow =
        lines.go(lines.go(lines.middle, {0, 0.5, 0}, steps, 0.3), {0.5, 0, 0}, 2, 0.3);
    lines.go(elbow, {0, -0.5, 0}, steps - 2, 0.3);
    EXPECT_EQ(lines.run().segments.size(), steps > 2 ? lines.segments.size() : trunk);
  }
}

// Where the trunk is ten times as thick as the rod: by its radii the rod ends a quarter of one outside.
TEST(PrunedLines, KeepsARodOnAThickTrunk) {
  for (const double thick : {0.1, 0.5}) {
    Pruned lines;
    std::fill(lines.ball.begin(), lines.ball.end(), 2);
    const std::size_t trunk = lines.segments.size();
    const std::uint32_t wall = lines.go(lines.middle, {0, 0.5, 0}, 3, 1);
    lines.go(wall, {0, 0.5, 0}, 2, thick);
    EXPECT_EQ(lines.run().segments.size(), thick < 0.2 ? lines.segments.size() : trunk);
  }
}

// A jar's handles meet low in its belly, which does not reach far beyond their joint.
TEST(PrunedLines, KeepsWhatLeadsThroughTheMiddleOfTheSolid) {
  Pruned lines;
  const std::uint32_t end = lines.go(lines.middle, {0, 0.5, 0}, 2, 1);
  EXPECT_EQ(lines.run(end - 1).segments.size(), lines.segments.size());
  EXPECT_EQ(lines.run(lines.middle).segments.size(), lines.segments.size() - 2);
}

// Noise parts hands from arms, and the arm then ends beside the hand.
TEST(PrunedLines, KeepsALimbThatEndsInAnotherPiece) {
  Pruned lines;
  lines.go(lines.middle, {0, 0.5, 0}, 10, 0.5);
  lines.go(lines.add({-1, 5.2, 0}, 0.5), {0.5, 0, 0}, 6, 0.5);
  EXPECT_EQ(lines.run().segments.size(), lines.segments.size());
}

}  // namespace
}  // namespace affskel::core

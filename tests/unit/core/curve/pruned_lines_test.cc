#include "core/curve/pruned_lines.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/curve/drawn_lines.h"

namespace affskel::core {
namespace {

// A trunk along x with balls of 1 about it.
struct Pruned : DrawnLines {
  std::vector<char> ends;
  std::uint32_t first = add({0, 0, 0}, 1), middle = go(first, {0.5, 0, 0}, 10, 1);
  std::uint32_t last = go(middle, {0.5, 0, 0}, 10, 1);

  SheetLines run(std::uint64_t most_loops) {
    ends.resize(places.size(), 0);
    ends[first] = ends[last] = 1;
    SheetLines lines;
    for (std::uint32_t v = 0; v < places.size(); ++v) lines.vertices.push_back(v);
    lines.segments = segments;
    return pruned_lines(lines, places, ball, ends, {.most_loops = most_loops});
  }
  // From the middle so far aside, along, and back to a vertex three steps on.
  void add_handle(int aside) {
    const std::uint32_t out = go(middle, {0, 0.5, 0}, aside, 0.2);
    const std::uint32_t along = go(out, {0.5, 0, 0}, 3, 0.2);
    join(go(along, {0, -0.5, 0}, aside - 1, 0.2), middle + 3);
  }
};

TEST(PrunedLines, OpensALoopInABallAndEatsIt) {
  Pruned lines;
  const std::size_t trunk = lines.segments.size();
  lines.add_handle(2);
  EXPECT_EQ(lines.run(1).segments.size(), trunk);
}

TEST(PrunedLines, KeepsLoopsThatAreNotToBeOpened) {
  Pruned lines;
  lines.add_handle(2);
  EXPECT_EQ(lines.run(0).segments.size(), lines.segments.size());
}

TEST(PrunedLines, KeepsALoopThatLeavesTheBall) {
  Pruned lines;
  lines.add_handle(5);
  EXPECT_EQ(lines.run(1).segments.size(), lines.segments.size());
}

// Its tip is no end before.
TEST(PrunedLines, KeepsTheLimbThatEndsInALoop) {
  Pruned lines;
  const std::uint32_t neck = lines.go(lines.middle, {0, 0.5, 0}, 8, 0.5);
  const std::uint32_t left = lines.go(neck, {-0.2, 0.2, 0}, 1, 0.4),
                      far = lines.go(left, {0.2, 0.2, 0}, 1, 0.3);
  const std::uint32_t right = lines.go(far, {0.2, -0.2, 0}, 1, 0.4);
  lines.join(right, neck);
  const SheetLines pruned = lines.run(1);
  EXPECT_GE(pruned.segments.size(), lines.segments.size() - 3) << "the limb stays";
  EXPECT_LT(pruned.segments.size(), lines.segments.size()) << "its loop does not";
}

TEST(PrunedLines, DropsASpurAndKeepsALimb) {
  for (const bool is_limb : {false, true}) {
    Pruned lines;
    const std::size_t trunk = lines.segments.size();
    const int steps = is_limb ? 4 : 3;  // to 2 and 1.5 radii from the trunk's line
    const std::uint32_t tip = lines.go(lines.middle, {0, 0.5, 0}, steps, 0.3);
    lines.ends.resize(lines.places.size(), 0);
    lines.ends[tip] = 1;
    EXPECT_EQ(lines.run(0).segments.size(), is_limb ? trunk + 4 : trunk);
  }
}

}  // namespace
}  // namespace affskel::core

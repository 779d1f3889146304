#include "core/curve/parted_lines.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

#include "core/base/none.h"
#include "core/curve/drawn_lines.h"
#include "core/mesh/polylines.h"

namespace affskel::core {
namespace {

constexpr double kStep = 0.1;

// Two joints with two limbs each, 0.5 thick, and a link along x between them.
struct Parted : DrawnLines {
  std::vector<double> radius;
  std::vector<PlaceMoments> moments;
  std::uint32_t one = add({}, 0), other, first, last;  // first, last: of the link between its joints

  explicit Parted(int steps) {
    other = go(one, {kStep, 0, 0}, steps, 0);
    first = one + 1;
    last = other - 1;
    for (const double y : {kStep, -kStep}) {
      go(one, {0, y, 0}, 30, 0);
      go(other, {0, y, 0}, 30, 0);
    }
    radius.assign(places.size(), 0.5);
    moments.resize(places.size());
  }

  // What is nearest to a vertex: places on a rectangle across the link.
  void give(std::uint32_t v, double width, double thickness) {
    for (int i = -5; i <= 5; ++i)
      for (int k = -5; k <= 5; ++k) {
        const Vec3 at = places[v] + Vec3{0, 0.1 * i * width, 0.1 * k * thickness};
        moments[v].add({1, at, outer(at, at)});
      }
  }

  PartedLines parted() const {
    return parted_lines({places, polylines(places.size(), segments), radius, moments, kStep});
  }
};

TEST(PartedLines, ALinkThatIsShorterThanThickIsABodys) {
  for (const int steps : {8, 12}) {  // 1 is twice its radius
    const Parted lines(steps);
    const PartedLines parted = lines.parted();
    EXPECT_EQ(parted.limb[lines.first] == kNone, steps == 8);
    EXPECT_EQ(parted.is_body[lines.first + 3] != 0, steps == 8);
    EXPECT_EQ(parted.limbs.size(), steps == 8 ? 4U : 5U);
  }
}

TEST(PartedLines, AFlatLinkIsABodys) {
  for (const double width : {1.5, 3.}) {
    Parted lines(40);
    for (std::uint32_t v = lines.first; v <= lines.last; ++v) lines.give(v, width, 1);
    EXPECT_EQ(lines.parted().limb[lines.first + 15] == kNone, width > 2);
  }
}

// Its ends, where it suddenly grows, are no limb's, and do not tell whether it is flat.
TEST(PartedLines, OnlyWhatIsALimbsTellsWhetherItIsFlat) {
  Parted lines(40);
  for (std::uint32_t v = lines.first; v <= lines.last; ++v) {
    const bool is_end = v < lines.first + 6 || v > lines.last - 6;
    if (is_end) lines.radius[v] = 3;
    lines.give(v, is_end ? 30 : 1, 1);
  }
  const PartedLines parted = lines.parted();
  EXPECT_NE(parted.limb[lines.first + 15], kNone);
  EXPECT_EQ(parted.limbs[parted.limb[lines.first + 15]].size, 0.5);
  EXPECT_TRUE(parted.is_body[lines.first + 5]);
  EXPECT_TRUE(parted.is_body[lines.last - 5]);
  EXPECT_FALSE(parted.is_body[lines.first + 15]);
}

TEST(PartedLines, GrowWhereASizeDoesOverAsMuch) {
  const Parted lines(20);
  const std::vector<std::uint32_t> line = polylines(lines.places.size(), lines.segments)[0];
  std::vector<double> size(lines.places.size(), 0.3);
  size[line[2]] = 0.5;
  EXPECT_TRUE(grows_at(lines.places, line, 2, size));
  EXPECT_FALSE(grows_at(lines.places, line, 3, size));
  size[line[2]] = 0.4;  // by 0.1 over a way of 0.4
  EXPECT_FALSE(grows_at(lines.places, line, 2, size));
}

}  // namespace
}  // namespace affskel::core

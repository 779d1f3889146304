#include "core/mesh/polylines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace affskel::core {
namespace {

using Lines = std::vector<std::vector<std::uint32_t>>;

Lines lines_of(std::size_t points, const std::vector<Segment>& segments) {
  return polylines(points, segments);
}

TEST(PolylinesTest, SegmentsInAnyOrderAndDirectionMakeOneLine) {
  EXPECT_EQ(lines_of(5, {{2, 1}, {3, 4}, {0, 1}, {3, 2}}), (Lines{{4, 3, 2, 1, 0}}));
  EXPECT_EQ(lines_of(2, {{0, 1}}), (Lines{{0, 1}}));
  EXPECT_EQ(lines_of(3, {}), Lines{});
}

TEST(PolylinesTest, LinesEndWhereThreeMeet) {
  EXPECT_EQ(lines_of(7, {{0, 1}, {1, 2}, {2, 3}, {2, 4}, {4, 5}}), (Lines{{0, 1, 2}, {2, 3}, {2, 4, 5}}));
}

TEST(PolylinesTest, AClosedLineBeginsAndEndsAtItsLeastPoint) {
  EXPECT_EQ(lines_of(4, {{3, 2}, {1, 3}, {2, 1}}), (Lines{{1, 3, 2, 1}}));
  // A loop at a crossing begins there.
  EXPECT_EQ(lines_of(4, {{1, 2}, {2, 3}, {3, 1}, {1, 0}}), (Lines{{1, 2, 3, 1}, {1, 0}}));
}

TEST(PolylinesTest, EverySegmentIsInOneLineOnce) {
  std::mt19937 random(3);
  for (int round = 0; round < 200; ++round) {
    const std::uint32_t points = 2 + static_cast<std::uint32_t>(random() % 12);
    std::vector<Segment> segments;
    for (std::uint32_t a = 0; a < points; ++a) {
      for (std::uint32_t b = a + 1; b < points; ++b) {
        if (random() % 3 == 0) segments.push_back(random() % 2 == 0 ? Segment{a, b} : Segment{b, a});
      }
    }
    std::shuffle(segments.begin(), segments.end(), random);
    std::vector<Segment> found;
    for (const auto& line : lines_of(points, segments)) {
      ASSERT_GE(line.size(), 2u);
      for (std::size_t i = 1; i < line.size(); ++i)
        found.push_back({std::min(line[i - 1], line[i]), std::max(line[i - 1], line[i])});
      for (std::size_t i = 1; i + 1 < line.size(); ++i) {
        EXPECT_EQ(std::count_if(segments.begin(), segments.end(),
                                [&](const Segment& s) { return s[0] == line[i] || s[1] == line[i]; }),
                  2);
      }
    }
    for (Segment& s : segments) std::sort(s.begin(), s.end());
    std::sort(segments.begin(), segments.end());
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, segments);
  }
}

TEST(PolylinesTest, APlaceAlongALineIsCountedFromEitherEnd) {
  const std::vector<Vec3> places{{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {2, 3, 0}};
  const std::vector<std::uint32_t> line{0, 1, 2, 3};
  EXPECT_EQ(place_along(places, line, false, 0), (Vec3{0, 0, 0}));
  EXPECT_EQ(place_along(places, line, false, 1), (Vec3{1, 0, 0}));
  EXPECT_EQ(place_along(places, line, false, 3), (Vec3{2, 1, 0}));
  EXPECT_EQ(place_along(places, line, true, 1), (Vec3{2, 2, 0}));
  EXPECT_EQ(place_along(places, line, true, 4), (Vec3{1, 0, 0}));
  EXPECT_EQ(place_along(places, line, false, 9), (Vec3{2, 3, 0})) << "no longer than the line";
}

}  // namespace
}  // namespace affskel::core

#include "core/ridge/drawn_out_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/mesh/mesh.h"

namespace affskel::core {
namespace {

// Below the surface of a tube with round ends, radius 1, from (0, 0, 0) to (5, 0, 0).
double in_tube(const Vec3& p) {
  return std::max(0.0, 1 - norm(p - Vec3{std::clamp(p.x, 0.0, 5.0), 0, 0}));
}

std::vector<MovedVertex> drawn_out(const std::vector<Vec3>& places, const std::vector<Segment>& segments) {
  return drawn_out_lines({places, neighbours(places.size(), segments), 0.07, in_tube});
}

struct Line {
  std::vector<Vec3> places;
  std::vector<Segment> segments;
};

// From a to b in steps of a quarter.
Line line(const Vec3& a, const Vec3& b) {
  Line made;
  const auto steps = static_cast<std::uint32_t>(std::lround(norm(b - a) / 0.25));
  for (std::uint32_t n = 0; n <= steps; ++n) {
    made.places.push_back(a + (double(n) / steps) * (b - a));
    if (n > 0) made.segments.push_back({n - 1, n});
  }
  return made;
}

TEST(DrawnOutLines, EndHalfAsDeepAsWhatTheyLeadTo) {
  const Line axis = line({0, 0, 0}, {5, 0, 0});
  const std::vector<MovedVertex> moved = drawn_out(axis.places, axis.segments);
  ASSERT_EQ(moved.size(), 8U);  // of a stretch of 1 at each end, but for its beginning
  for (const MovedVertex& vertex : moved) {
    const double before = axis.places[vertex.vertex].x;
    const double outwards = before < 2.5 ? -0.5 * (1 - before) : 0.5 * (before - 4);
    EXPECT_NEAR(vertex.place.x, before + outwards, 1e-9) << before;
    EXPECT_EQ(vertex.place.y, 0);
  }
}

// A line along a limb that goes on is longer by its depth.
TEST(DrawnOutLines, AreLongerByNoMoreThanTheirDepth) {
  const Line half = line({1, 0, 0}, {3, 0, 0});
  const std::vector<MovedVertex> moved = drawn_out(half.places, half.segments);
  EXPECT_NEAR(moved.back().place.x, 4, 0.08);
  EXPECT_EQ(moved.front().place.x, 0);
}

// Where lines meet, what is shorter than it is deep stays; the third, long enough, goes on.
TEST(DrawnOutLines, AreNoShorterThanTheyAreDeep) {
  Line fork = line({3, 0, 0}, {4.5, 0, 0});
  fork.places.insert(fork.places.end(), {{4.5, 0.25, 0}, {4.5, -0.25, 0}, {4.5, -0.55, 0}});
  fork.segments.insert(fork.segments.end(), {{6, 7}, {6, 8}, {8, 9}});
  std::vector<std::uint32_t> moved;
  for (const MovedVertex& vertex : drawn_out(fork.places, fork.segments)) moved.push_back(vertex.vertex);
  EXPECT_EQ(moved, (std::vector<std::uint32_t>{0, 1, 2, 3, 8, 9}));
}

// A line that bends round a hole of the solid would be drawn into it; of a thin solid a step would lead out.
TEST(DrawnOutLines, StayInTheSolid) {
  const auto holed = [](double x) {
    return [x](const Vec3& p) {
      return norm(p - Vec3{x, 0.5, 0}) < 0.2 ? 0.0 : std::clamp((12 - p.x) / 2, 0.0, 1.0);
    };
  };
  const std::vector<Vec3> bent{{10, 0, 0}, {9.2, 0.5, 0}, {8.9, 0, 0}, {8, 0, 0}};
  const std::vector<Segment> segments{{0, 1}, {1, 2}, {2, 3}};
  EXPECT_EQ(drawn_out_lines({bent, neighbours(4, segments), 0.07, holed(20)}).size(), 4U);
  const std::vector<MovedVertex> round = drawn_out_lines({bent, neighbours(4, segments), 0.07, holed(9.6)});
  ASSERT_FALSE(round.empty());
  for (const MovedVertex& vertex : round) EXPECT_GT(vertex.vertex, 1U);
  const auto in_wire = [](const Vec3& p) {
    return std::max(0.0, 0.01 - norm(p - Vec3{std::clamp(p.x, 0.0, 5.0), 0, 0}));
  };
  const Line wire = line({0, 0, 0}, {5, 0, 0});
  const std::vector<MovedVertex> moved =
      drawn_out_lines({wire.places, neighbours(wire.places.size(), wire.segments), 0.07, in_wire});
  ASSERT_EQ(moved.size(), 2U);
  EXPECT_NEAR(moved[1].place.x, 5.005, 1e-9);
}

// A surface has no end, and one place no direction.
TEST(DrawnOutLines, AreNoneOfSurfacesAndPoints) {
  const std::vector<Vec3> places{{2, 0, 0}, {3, 0, 0}, {2, 0.5, 0}, {4, 0, 0}};
  EXPECT_TRUE(drawn_out(places, {{0, 1}, {1, 2}, {2, 0}}).empty());
  EXPECT_TRUE(drawn_out({{2, 0, 0}, {2, 0, 0}}, {{0, 1}}).empty());
}

}  // namespace
}  // namespace affskel::core

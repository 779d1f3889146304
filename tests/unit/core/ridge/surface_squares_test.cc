#include "core/ridge/surface_squares.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/split_mix64.h"

namespace affskel::core {
namespace {

constexpr double kLowBound = 6, kStrong = 9, kWeak = 3;
constexpr std::uint32_t kColumns = 20, kRows = 20;

std::uint32_t vertex_at(std::uint32_t x, std::uint32_t y) {
  return y * (kColumns + 1) + x;
}
std::uint32_t square_at(std::uint32_t x, std::uint32_t y) {
  return y * kColumns + x;
}

// A plane of squares that is weak, but for vertices that are made strong.
struct SquarePlane {
  EdgeCells cells;
  std::vector<SheetVertex> vertices{(kColumns + 1) * (kRows + 1)};
  std::vector<double> strength, radius;

  SquarePlane() {
    for (SheetVertex& v : vertices) v.strength = kWeak;
    for (std::uint32_t y = 0; y < kRows; ++y)
      for (std::uint32_t x = 0; x < kColumns; ++x)
        add({vertex_at(x, y), vertex_at(x + 1, y), vertex_at(x + 1, y + 1), vertex_at(x, y + 1)}, kWeak);
  }
  void add(const std::array<std::uint32_t, 4>& ring, double own) {
    cells.ring.push_back(ring);
    strength.push_back(own);
    radius.push_back(8);
  }
  void strengthen(std::uint32_t x_end, std::uint32_t y_begin, std::uint32_t y_end) {
    for (std::uint32_t y = y_begin; y < y_end; ++y)
      for (std::uint32_t x = 4; x < x_end; ++x) vertices[vertex_at(x, y)].strength = kStrong;
  }
  SurfaceSquares select(double gap) const {
    return surface_squares({cells, vertices, strength, radius}, kLowBound, gap);
  }
};

std::size_t count_taken(const SurfaceSquares& squares) {
  return static_cast<std::size_t>(std::count(squares.taken.begin(), squares.taken.end(), 1));
}

// Vertices 4 .. 16 are strong in rows 4 .. 7 and from row 11 on: two rows of squares lie between.  With half a radius,
// four squares, they close but for where the gap is as near to its ends as that; with less than a square nothing does.
TEST(SurfaceSquares, AreClosedAcrossANarrowGap) {
  SquarePlane plane;
  plane.strengthen(17, 4, 8);
  plane.strengthen(17, 11, 17);
  const SurfaceSquares apart = plane.select(0.1), closed = plane.select(0.5);
  EXPECT_EQ(count_taken(apart), 14U * (5 + 7));
  EXPECT_NE(apart.piece[square_at(10, 5)], apart.piece[square_at(10, 13)]);
  EXPECT_EQ(closed.piece[square_at(10, 5)], closed.piece[square_at(10, 13)]);
  for (std::uint32_t y = 8; y < 10; ++y) EXPECT_TRUE(closed.taken[square_at(10, y)]);
  for (std::uint32_t y = 0; y < kRows; ++y)
    for (std::uint32_t x = 0; x < kColumns; ++x)
      EXPECT_FALSE(closed.taken[square_at(x, y)] && (x < 3 || x > 16 || y < 3 || y > 16)) << x << ' ' << y;
}

TEST(SurfaceSquares, StayApartAcrossAWideGap) {
  SquarePlane plane;
  plane.strengthen(17, 4, 5);
  plane.strengthen(17, 15, 17);
  const SurfaceSquares squares = plane.select(0.5);
  EXPECT_FALSE(squares.taken[square_at(10, 9)]);
  EXPECT_NE(squares.piece[square_at(10, 4)], squares.piece[square_at(10, 15)]);
}

// Where the solid grows thinner outwards ways there are longer, and closing alone would move the rim out by a square.
TEST(SurfaceSquares, KeepTheRimWhereTheSolidGrowsThinner) {
  SquarePlane plane;
  plane.strengthen(17, 4, 12);
  for (std::uint32_t y = 12; y < kRows; ++y)
    for (std::uint32_t x = 0; x < kColumns; ++x) plane.radius[square_at(x, y)] = 8 - 0.8 * (y - 11);
  EXPECT_EQ(plane.select(0.5).taken, plane.select(0).taken);
}

// On a plane with random strengths, and squares that stand on it.
TEST(SurfaceSquares, AreTheMoreTheLowerTheBound) {
  SquarePlane plane;
  SplitMix64 random(1);
  const auto any_strength = [&] { return 5.5 + 4.5 * random.symmetric(); };
  for (SheetVertex& v : plane.vertices) v.strength = any_strength();
  for (std::uint32_t x = 2; x < kColumns; x += 3)
    plane.add({vertex_at(x, 9), vertex_at(x + 1, 9), vertex_at(x, 12), vertex_at(x + 1, 12)}, 0);
  for (double& own : plane.strength) own = any_strength();
  std::vector<char> taken(plane.strength.size(), 0);
  for (double low = 10; low > 1; low -= 0.25) {
    const std::vector<char> more =
        surface_squares({plane.cells, plane.vertices, plane.strength, plane.radius}, low, 0.3).taken;
    for (std::size_t square = 0; square < taken.size(); ++square)
      EXPECT_LE(taken[square], more[square]) << low;
    taken = more;
  }
}

// The third square at an edge is one of the surface's branches if its own crossing is clearly strong.
TEST(SurfaceSquares, LeaveOutWeakOnesThatStandOnOthers) {
  for (const double own : {kWeak, 1.4 * kLowBound, kStrong}) {
    SquarePlane plane;
    plane.strengthen(17, 4, 17);
    std::fill(plane.strength.begin(), plane.strength.end(), kStrong);
    const auto added = static_cast<std::uint32_t>(plane.vertices.size());
    plane.vertices.resize(added + 2, plane.vertices[0]);
    plane.add({vertex_at(10, 10), vertex_at(11, 10), added, added + 1}, own);
    const SurfaceSquares squares = plane.select(0.5);
    EXPECT_EQ(squares.taken.back(), own == kStrong);
    EXPECT_TRUE(squares.taken[square_at(10, 10)]);
  }
}

}  // namespace
}  // namespace affskel::core

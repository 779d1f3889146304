#include "core/curve/burn_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "core/curve/sheet_lines.h"

namespace affskel::core {
namespace {

// Walls of unit squares, in two triangles each, that meet where their places do.
class Walls {
 public:
  void add_square(const Vec3& corner, const Vec3& u, const Vec3& v) {
    const std::uint32_t a = vertex(corner), b = vertex(corner + u), c = vertex(corner + u + v),
                        d = vertex(corner + v);
    sheet_.triangles.insert(sheet_.triangles.end(), {{a, b, c}, {a, c, d}});
  }

  // @param nu, nv how many squares.
  void add(const Vec3& corner, const Vec3& u, const Vec3& v, int nu, int nv) {
    for (int i = 0; i < nu; ++i)
      for (int j = 0; j < nv; ++j) add_square(corner + double(i) * u + double(j) * v, u, v);
  }

  std::uint32_t vertex(const Vec3& at) {
    const auto [known, fresh] =
        numbers_.try_emplace({at.x, at.y, at.z}, static_cast<std::uint32_t>(sheet_.vertices.size()));
    if (fresh) {
      sheet_.vertices.emplace_back().position = at;
      sheet_.part.push_back(0);
    }
    return known->second;
  }

  SheetMesh& sheet() { return sheet_; }

  // When the last of the triangles about a place burns there.
  double time(const Vec3& at) {
    const std::vector<char> left(sheet_.triangles.size(), 1);
    const std::vector<double> times = burn_times(sheet_, SheetEdges(sheet_), left);
    double last = 0;
    for (std::size_t t = 0; t < sheet_.triangles.size(); ++t)
      for (std::size_t k = 0; k < 3; ++k)
        if (sheet_.triangles[t][k] == vertex(at)) last = std::max(last, times[3 * t + k]);
    return last;
  }

 private:
  SheetMesh sheet_;
  std::map<std::tuple<double, double, double>, std::uint32_t> numbers_;
};

const Vec3 kX{1, 0, 0}, kY{0, 1, 0}, kZ{0, 0, 1};

Walls plate() {
  Walls walls;
  walls.add({0, 0, 0}, kX, kY, 20, 12);
  return walls;
}

TEST(BurnTimes, AreTheWayToTheRim) {
  Walls walls = plate();
  EXPECT_EQ(walls.time({0, 5, 0}), 0);
  EXPECT_EQ(walls.time({3, 6, 0}), 3);
  EXPECT_EQ(walls.time({10, 6, 0}), 6);
  EXPECT_EQ(walls.time({10, 10, 0}), 2);
}

// A fin in the middle, 2 high and 4 long.
TEST(BurnTimes, WaitWhereAFinStands) {
  Walls walls = plate();
  walls.add({8, 6, 0}, kX, kZ, 4, 2);
  EXPECT_EQ(walls.time({10, 6, 2}), 0);
  EXPECT_EQ(walls.time({10, 6, 1}), 1);
  EXPECT_EQ(walls.time({10, 6, 0}), 6) << "its own rim is 2 away";
  EXPECT_EQ(walls.time({10, 5, 0}), 5);
}

// The fin is higher than the plate is wide, and burns from below, too.
TEST(BurnTimes, GoOnIntoWhatIsLeftAlone) {
  Walls walls = plate();
  walls.add({-20, 6, 0}, kX, kZ, 20, 20);  // the fin goes on beyond the plate
  walls.add({0, 6, 0}, kX, kZ, 40, 20);
  EXPECT_EQ(walls.time({10, 6, 0}), 6);
  EXPECT_EQ(walls.time({10, 6, 4}), 10);
  EXPECT_EQ(walls.time({10, 6, 18}), 2);
}

TEST(BurnTimes, WaitAtAPointWhereSheetsTouch) {
  Walls walls = plate();
  walls.add({10, 6, 0}, kX + kZ, kY + kZ, 3, 3);
  EXPECT_EQ(walls.time({10, 6, 0}), 6);
  EXPECT_EQ(walls.time({9, 6, 0}), 6);
}

TEST(BurnTimes, AreNoneOfAClosedSurface) {
  Walls box;
  for (const double z : {0., 6.}) box.add({0, 0, z}, kX, kY, 6, 6);
  for (const double y : {0., 6.}) box.add({0, y, 0}, kX, kZ, 6, 6);
  for (const double x : {0., 6.}) box.add({x, 0, 0}, kY, kZ, 6, 6);
  EXPECT_TRUE(std::isinf(box.time({3, 3, 0})));
  box.add({2, 3, 6}, kX, kZ, 2, 2);
  EXPECT_EQ(box.time({3, 3, 7}), 1);
  EXPECT_TRUE(std::isinf(box.time({3, 3, 6})));
}

// A wall between two closed boxes burns though they do not, from its rims: a line through it runs in its middle, whichever way
// vertices are numbered.
TEST(BurnTimes, LeadLinesThroughTheMiddleOfAWallBetweenClosedBoxes) {
  for (const bool backwards : {false, true}) {
    Walls walls;
    const auto box = [&](double x) {
      for (const double z : {-2., 2.}) walls.add({x, 0, z}, kX, kY, 4, 10);
      for (const double y : {0., 10.}) walls.add({x, y, -2}, kX, kZ, 4, 4);
      for (const double at : {x, x + 4}) walls.add({at, 0, -2}, kY, kZ, 10, 4);
    };
    box(0);
    box(6);
    walls.add({4, 0, 0}, kX, kY, 2, 10);
    SheetMesh sheet = walls.sheet();
    std::vector<char> ends(sheet.vertices.size(), 0);
    for (const double x : {0., 10.}) ends[walls.vertex({x, 5, 0})] = 1;
    if (backwards) {
      const auto last = static_cast<std::uint32_t>(sheet.vertices.size() - 1);
      std::reverse(sheet.vertices.begin(), sheet.vertices.end());
      std::reverse(ends.begin(), ends.end());
      for (Triangle& t : sheet.triangles) t = {last - t[0], last - t[1], last - t[2]};
    }
    int within = 0;
    for (const std::uint32_t v : sheet_lines(sheet, ends).vertices) {
      const Vec3& at = sheet.vertices[v].position;
      if (at.x <= 4 || at.x >= 6) continue;
      EXPECT_EQ(at.y, 5);
      ++within;
    }
    EXPECT_EQ(within, 1);
  }
}

// A strip that is turned over and closed: it has one rim.
TEST(BurnTimes, GoAroundAMoebiusStrip) {
  constexpr std::uint32_t kAround = 40;
  SheetMesh strip;
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (int j = -2; j <= 2; ++j) {
      const double angle = 2 * 3.14159265358979 * i / kAround, r = 10 + j * std::cos(angle / 2);
      strip.vertices.emplace_back().position = {r * std::cos(angle), r * std::sin(angle),
                                                j * std::sin(angle / 2)};
      strip.part.push_back(0);
    }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return i == kAround ? 4 - j : 5 * i + j; };
  for (std::uint32_t i = 0; i < kAround; ++i)
    for (std::uint32_t j = 0; j < 4; ++j) {
      strip.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      strip.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  const std::vector<double> times =
      burn_times(strip, SheetEdges(strip), std::vector<char>(strip.triangles.size(), 1));
  for (std::size_t t = 0; t < strip.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t j = strip.triangles[t][k] % 5;
      EXPECT_NEAR(times[3 * t + k], std::min(j, 4 - j), 0.01);
    }
}

TEST(BurnTimes, AreNoneOfWhatIsNotThere) {
  Walls walls = plate();
  std::vector<char> left(walls.sheet().triangles.size(), 1);
  left[0] = 0;
  const std::vector<double> times = burn_times(walls.sheet(), SheetEdges(walls.sheet()), left);
  EXPECT_TRUE(std::isinf(times[0]));
  EXPECT_EQ(*std::min_element(times.begin(), times.end()), 0);
  const SheetMesh none;
  EXPECT_TRUE(burn_times(none, SheetEdges(none), {}).empty());
}

// Two narrow fins that cross on a plate, where a line begins: once they are gone, their rims have not eaten the plate's
// middle.
TEST(BurnTimes, LeadLinesStraightThroughThePlateThatFinsStandOn) {
  Walls walls;
  walls.add({-12, -12, 0}, kX, kY, 24, 24);
  walls.add({-2, 0, 0}, kX, kZ, 4, 1);
  walls.add({0, -2, 0}, kY, kZ, 4, 1);
  SheetMesh& sheet = walls.sheet();
  std::vector<char> ends(sheet.vertices.size(), 0);
  for (const Vec3& at : {Vec3{-2, 0, 0}, Vec3{2, 0, 0}}) ends[walls.vertex(at)] = 1;
  for (const std::uint32_t v : sheet_lines(sheet, ends).vertices)
    EXPECT_LE(norm(sheet.vertices[v].position), 3);
}

}  // namespace
}  // namespace affskel::core

#include "core/curve/burn_times.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <tuple>
#include <vector>

#include "core/curve/sheet_lines.h"
#include "core/shapes/shapes.h"

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

  double time(const Vec3& at) {
    const std::vector<char> left(sheet_.triangles.size(), 1);
    return burn_times(sheet_, SheetEdges(sheet_), left)[vertex(at)];
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

#include "core/curve/sheet_lines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/mesh/unused_points.h"
#include "core/quality/sheet_topology.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// Squares of side 1 in the plane z = 0, where `there` says so of their middle, in two triangles each.  E is
// greatest at (mx, my).
SheetMesh flat_sheet(
    std::uint32_t nx, std::uint32_t ny,
    const std::function<bool(double, double)>& there = [](double, double) { return true; }) {
  SheetMesh sheet;
  for (std::uint32_t j = 0; j <= ny; ++j)
    for (std::uint32_t i = 0; i <= nx; ++i) {
      SheetVertex vertex;
      vertex.position = {static_cast<double>(i), static_cast<double>(j), 0};
      vertex.erosion = 1 / (1 + std::hypot(i - 0.5 * nx, j - 0.5 * ny));
      sheet.vertices.push_back(vertex);
    }
  const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (nx + 1) + i; };
  for (std::uint32_t j = 0; j < ny; ++j)
    for (std::uint32_t i = 0; i < nx; ++i) {
      if (!there(i + 0.5, j + 0.5)) continue;
      sheet.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      sheet.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  sheet.part.assign(sheet.vertices.size(), 0);
  return sheet;
}

BettiNumbers betti(const SheetMesh& sheet, const SheetLines& lines) {
  Mesh mesh;
  for (const std::uint32_t v : lines.vertices) mesh.points.push_back(sheet.vertices[v].position);
  return sheet_betti_numbers(mesh, lines.segments);
}

std::vector<std::uint32_t> ends_of(const SheetLines& lines) {
  std::vector<std::uint32_t> degree(lines.vertices.size(), 0), ends;
  for (const Segment& segment : lines.segments)
    for (const std::uint32_t v : segment) ++degree[v];
  for (std::size_t v = 0; v < degree.size(); ++v)
    if (degree[v] == 1) ends.push_back(lines.vertices[v]);
  return ends;
}

TEST(SheetLines, RunInTheMiddleOfAStripFromEndToEnd) {
  const SheetMesh sheet = flat_sheet(40, 8);
  std::vector<char> ends(sheet.vertices.size(), 0);
  const std::uint32_t first = 4 * 41, last = 4 * 41 + 40;
  ends[first] = ends[last] = 1;
  const SheetLines lines = sheet_lines(sheet, ends);
  EXPECT_EQ(ends_of(lines), (std::vector<std::uint32_t>{first, last}));
  EXPECT_EQ(betti(sheet, lines), (BettiNumbers{1, 0, 0}));
  for (const std::uint32_t v : lines.vertices) EXPECT_NEAR(sheet.vertices[v].position.y, 4, 1);
}

// From an end on the long side straight to the line in the middle, whichever way the squares are cut.
TEST(SheetLines, LeadStraightAwayFromARim) {
  const SheetMesh sheet = flat_sheet(60, 20);
  std::vector<char> ends(sheet.vertices.size(), 0);
  ends[10 * 61] = ends[10 * 61 + 60] = 1;
  ends[30] = 1;            // below the middle
  ends[20 * 61 + 30] = 1;  // and above
  const SheetLines lines = sheet_lines(sheet, ends);
  EXPECT_EQ(ends_of(lines).size(), 4U);
  for (const std::uint32_t v : lines.vertices) {
    const Vec3& at = sheet.vertices[v].position;
    if (std::abs(at.y - 10) > 2) {
      EXPECT_NEAR(at.x, 30, 1) << at.y;
    }
  }
}

TEST(SheetLines, GoRoundAHoleInTheMiddle) {
  Mesh used = mesh_of(flat_sheet(40, 40, [](double x, double y) {
    const double r = std::hypot(x - 20, y - 20);
    return r > 8 && r < 19;
  }));
  drop_unused_points(used);
  SheetMesh ring;
  ring.triangles = used.triangles;
  for (const Vec3& at : used.points) ring.vertices.emplace_back().position = at;
  ring.part.assign(ring.vertices.size(), 0);
  const SheetLines lines = sheet_lines(ring, std::vector<char>(ring.vertices.size(), 0));
  EXPECT_EQ(betti(ring, lines), (BettiNumbers{1, 1, 0}));
  EXPECT_TRUE(ends_of(lines).empty());
  for (const std::uint32_t v : lines.vertices) {
    const Vec3& at = ring.vertices[v].position;
    EXPECT_NEAR(std::hypot(at.x - 20, at.y - 20), 13.5, 2);
  }
}

TEST(SheetLines, OfASheetWithoutEndsAreThePlaceOfTheGreatestE) {
  const SheetMesh sheet = flat_sheet(30, 12);
  std::vector<char> ends(sheet.vertices.size(), 0);
  SheetLines lines = sheet_lines(sheet, ends);
  ASSERT_EQ(lines.vertices.size(), 1U);
  EXPECT_EQ(lines.vertices[0], 6U * 31 + 15);
  EXPECT_TRUE(lines.segments.empty());
  // And with one end the line from there.
  ends[6 * 31] = 1;
  lines = sheet_lines(sheet, ends);
  EXPECT_EQ(ends_of(lines), (std::vector<std::uint32_t>{6U * 31, 6U * 31 + 15}));
}

// The axis of a bottle, whose body is too short for a limb.
TEST(SheetLines, GoOnToTheEndOfALineThroughThePlaceOfTheGreatestE) {
  SheetMesh axis;
  for (std::uint32_t v = 0; v < 9; ++v) {
    axis.vertices.emplace_back();
    axis.vertices.back().position = {static_cast<double>(v), 0, 0};
    axis.vertices.back().erosion = v == 6 ? 2 : 1;
    if (v > 0) axis.segments.push_back({v - 1, v});
  }
  std::vector<char> ends(9, 0);
  EXPECT_EQ(sheet_lines(axis, ends).vertices, (std::vector<std::uint32_t>{6}));
  ends[0] = 1;
  EXPECT_EQ(ends_of(sheet_lines(axis, ends)), (std::vector<std::uint32_t>{0, 8}));
}

TEST(SheetLines, OpenAClosedSurfaceWhereEIsLeast) {
  const Mesh ball = make_sphere(1, 320);
  SheetMesh sheet;
  for (const Vec3& place : ball.points) {
    SheetVertex vertex;
    vertex.position = place;
    vertex.erosion = 2 + place.z;
    sheet.vertices.push_back(vertex);
  }
  sheet.triangles = ball.triangles;
  const SheetLines lines = sheet_lines(sheet, std::vector<char>(sheet.vertices.size(), 0));
  ASSERT_EQ(lines.opened.size(), 1U);
  EXPECT_LT(sheet.vertices[lines.opened[0]].position.z, -0.9);
  ASSERT_EQ(lines.vertices.size(), 1U);
  EXPECT_GT(sheet.vertices[lines.vertices[0]].position.z, 0.9);
  // Opened above, it would not keep the whole way from an end above to one below.
  std::vector<char> ends(sheet.vertices.size(), 0);
  ends[lines.vertices[0]] = 1;
  EXPECT_EQ(sheet_lines(sheet, ends).vertices.size(), 1U);
}

// Pieces of a grid with holes, crossed by others, and segments: pieces and tunnels stay, ends are those asked for
// and centres.
TEST(SheetLines, KeepPiecesAndTunnels) {
  std::uint64_t tunnels = 0, opened = 0;
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    SplitMix64 random(seed);
    const auto chance = [&](std::uint64_t one_in) { return random.next() % one_in == 0; };
    // Faces and segments of a grid of 5 x 5 x 5 points: walls, branches, closed boxes.
    constexpr std::uint32_t kSide = 5;
    SheetMesh sheet;
    for (std::uint32_t n = 0; n < kSide * kSide * kSide; ++n) {
      SheetVertex vertex;
      vertex.position = {static_cast<double>(n / 25), static_cast<double>(n / 5 % 5),
                         static_cast<double>(n % 5)};
      vertex.erosion = static_cast<double>(random.next() >> 40);
      sheet.vertices.push_back(vertex);
    }
    const std::array<std::uint32_t, 3> step{25, 5, 1};
    const std::uint64_t sparse = 1 + random.next() % 5;
    for (std::uint32_t n = 0; n < sheet.vertices.size(); ++n) {
      const std::array<std::uint32_t, 3> at{n / 25, n / 5 % 5, n % 5};
      for (std::size_t a = 0; a < 3; ++a) {
        const std::size_t b = (a + 1) % 3;
        if (at[a] + 1 == kSide) continue;
        if (chance(8)) sheet.segments.push_back({n, n + step[a]});
        if (at[b] + 1 == kSide || !chance(sparse)) continue;
        sheet.triangles.push_back({n, n + step[a], n + step[a] + step[b]});
        sheet.triangles.push_back({n, n + step[a] + step[b], n + step[b]});
      }
    }
    const BettiNumbers before = sheet_betti_numbers(mesh_of(sheet), sheet.segments);
    std::vector<char> ends(sheet.vertices.size(), 0);
    for (char& end : ends) end = chance(12);
    const SheetLines lines = sheet_lines(sheet, ends);
    const BettiNumbers after = betti(sheet, lines);
    EXPECT_EQ(after.components, before.components) << seed;
    EXPECT_EQ(after.holes, before.holes) << seed;
    EXPECT_EQ(lines.opened.size(), before.cavities) << seed;
    for (std::size_t v = 0; v < ends.size(); ++v) {
      EXPECT_TRUE(!ends[v] || std::binary_search(lines.vertices.begin(), lines.vertices.end(), v)) << seed;
    }
    tunnels += before.holes;
    opened += before.cavities;
  }
  EXPECT_GT(tunnels, 1000U);
  EXPECT_GT(opened, 1000U);
}

}  // namespace
}  // namespace affskel::core

#include "core/quality/sheet_topology.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// A band of `n` squares, closed to a ring, with a twist or without.
Mesh band(std::uint32_t n, bool twisted) {
  Mesh mesh;
  mesh.points.resize(2 * n);
  for (std::uint32_t s = 0; s < n; ++s) {
    const bool cross = twisted && s + 1 == n;
    const std::uint32_t a = 2 * s, b = a + 1, c = 2 * ((s + 1) % n) + (cross ? 1 : 0),
                        d = 2 * ((s + 1) % n) + (cross ? 0 : 1);
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
  }
  return mesh;
}

// The faces of a cube over 8 vertices, and if wanted a wall through two opposite edges.
Mesh cube(bool with_lid, bool with_wall) {
  Mesh mesh;
  mesh.points.resize(8);
  const auto square = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  square(0, 1, 2, 3);
  for (std::uint32_t s = 0; s < 4; ++s) square(s, (s + 1) % 4, 4 + (s + 1) % 4, 4 + s);
  if (with_lid) square(4, 5, 6, 7);
  if (with_wall) square(0, 2, 6, 4);
  return mesh;
}

void expect_topology(const Mesh& sheet, const BettiNumbers& betti) {
  EXPECT_EQ(sheet_betti_numbers(sheet), betti);
}

TEST(SheetTopology, OfNothingAndOfATriangle) {
  expect_topology({}, {0, 0, 0});
  Mesh lone;
  lone.points.resize(5);  // two of them used by nothing: pieces of their own
  lone.triangles = {{1, 2, 4}};
  expect_topology(lone, {3, 0, 0});
}

TEST(SheetTopology, OfBands) {
  expect_topology(band(6, false), {1, 1, 0});
  expect_topology(band(7, true), {1, 1, 0});
  Mesh two = joined(band(6, false), band(7, true));
  expect_topology(two, {2, 2, 0});
}

TEST(SheetTopology, OfClosedSurfaces) {
  expect_topology(make_sphere(1, 80), {1, 0, 1});
  expect_topology(make_torus(3, 1, 128), {1, 2, 1});
  expect_topology(hollow_ball(), {2, 0, 2});
}

TEST(SheetTopology, OfSheetsThatBranch) {
  // Three wings on a common edge.
  Mesh wings;
  wings.points.resize(5);
  wings.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 1, 4}};
  expect_topology(wings, {1, 0, 0});
  // Two triangles that meet at a vertex only.
  Mesh tie;
  tie.points.resize(5);
  tie.triangles = {{0, 1, 2}, {0, 3, 4}};
  expect_topology(tie, {1, 0, 0});
}

// The wall shares the diagonals of floor and lid and two upright edges, where three triangles meet or four.
TEST(SheetTopology, CountsChambers) {
  expect_topology(cube(true, false), {1, 0, 1});
  expect_topology(cube(false, false), {1, 0, 0});
  expect_topology(cube(true, true), {1, 0, 2});
  // Without the lid no chamber is closed.
  EXPECT_EQ(sheet_betti_numbers(cube(false, true)), (BettiNumbers{1, 0, 0}));
  // A fin on a closed surface changes nothing.
  Mesh finned = cube(true, false);
  finned.points.resize(9);
  finned.triangles.push_back({0, 1, 8});
  expect_topology(finned, {1, 0, 1});
}

BettiNumbers with_segments(const Mesh& sheet, const std::vector<std::array<std::uint32_t, 2>>& segments) {
  return sheet_betti_numbers(sheet, segments);
}

TEST(SheetTopology, CountsCurves) {
  Mesh points;
  points.points.resize(6);
  EXPECT_EQ(with_segments(points, {{0, 1}, {1, 2}, {4, 3}}), (BettiNumbers{3, 0, 0}));
  EXPECT_EQ(with_segments(points, {{0, 1}, {1, 2}, {2, 0}, {0, 5}}), (BettiNumbers{3, 1, 0}));
  // A handle on a triangle, a curve that hangs on another, and segments along an edge and given twice.
  Mesh two = points;
  two.triangles = {{0, 1, 2}};
  EXPECT_EQ(with_segments(two, {{2, 3}, {3, 4}, {4, 0}, {1, 5}}), (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(with_segments(two, {{1, 0}, {2, 3}, {3, 2}}), (BettiNumbers{3, 0, 0}));
  // Two spheres, joined by two curves.
  Mesh balls = joined(make_sphere(1, 20), make_sphere(1, 20));
  const auto second = static_cast<std::uint32_t>(balls.points.size() / 2);
  EXPECT_EQ(with_segments(balls, {{0, second}, {1, second + 1}}), (BettiNumbers{1, 1, 2}));
}

}  // namespace
}  // namespace affskel::core

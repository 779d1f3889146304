#include "core/ridge/round_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/ridge/ridge_meshes.h"

namespace affskel::core {
namespace {

bool everywhere(const Vec3&) {
  return true;
}

// A body, x < 10, a limb of width 4 and a hand, x > 22.
bool limb_and_hand(double x, double y) {
  return x < 10 || x > 22 || (y > 13 && y < 17);
}

bool joined_to_sheet(const SheetMesh& mesh, std::uint32_t vertex) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(),
                     [&](const Triangle& t) { return std::find(t.begin(), t.end(), vertex) != t.end(); });
}

TEST(RoundSheet, BetweenTwoSheetsBecomesACurveThatJoinsThem) {
  SheetMesh mesh = part_of_square(30, limb_and_hand);
  ASSERT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(put_curves(mesh, std::vector{line(11, 21, 3)}, everywhere), 1U);
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  std::size_t ends = 0;
  for (const auto& segment : mesh.segments)
    for (const std::uint32_t v : segment) ends += joined_to_sheet(mesh, v);
  EXPECT_EQ(ends, 2U);
  // Nothing of the strip is left but about its ends.
  for (const Triangle& t : mesh.triangles) {
    const double x = mesh.vertices[t[0]].position.x;
    EXPECT_TRUE(x < 13.5 || x > 18.5) << x;
  }
}

// Between the sheet, z = 0, and the curve, z = 0.2, where `wall` holds, the solid is left.
std::function<bool(const Vec3&)> parted(std::function<bool(const Vec3&)> wall) {
  return [wall = std::move(wall)](const Vec3& at) { return at.z < 0.05 || at.z > 0.15 || !wall(at); };
}

TEST(RoundSheet, IsJoinedInsideTheSolid) {
  // The nearest vertex is behind a wall, others beside it are not.
  const auto inside = parted([](const Vec3& at) { return at.x < 13 && std::abs(at.y - 15) < 0.2; });
  SheetMesh mesh = part_of_square(30, limb_and_hand);
  EXPECT_EQ(put_curves(mesh, std::vector{line(11, 21, 3)}, inside), 1U);
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  for (const auto& [a, b] : mesh.segments) {
    const Vec3 &from = mesh.vertices[a].position, &to = mesh.vertices[b].position;
    for (int k = 0; k <= 100; ++k) EXPECT_TRUE(inside(from + 0.01 * k * (to - from)));
  }
}

TEST(RoundSheet, StaysWhereEveryJointWouldLeaveTheSolid) {
  const auto inside = parted([](const Vec3& at) { return at.x < 15 && at.y > 10; });
  SheetMesh mesh = part_of_square(30, limb_and_hand);
  const SheetMesh before = mesh;
  EXPECT_EQ(put_curves(mesh, std::vector{line(11, 21, 3)}, inside), 0U);
  EXPECT_EQ(mesh.triangles, before.triangles);
  EXPECT_TRUE(mesh.segments.empty());
  // Another limb's curve is put in all the same.
  SheetMesh two = part_of_square(30, [](double x, double y) { return limb_and_hand(x, y) || y < 4; });
  RidgeCurve other = line(11, 21, 3);
  for (SheetVertex& v : other.vertices) v.position.y = 2;
  EXPECT_EQ(put_curves(two, std::vector{line(11, 21, 3), other}, inside), 1U);
  EXPECT_EQ(topology(two).betti, (BettiNumbers{1, 1, 0}));
}

TEST(RoundSheet, LosesTheTunnelsOfAStrip) {
  // Slits in the limb, and a bridge over it.
  SheetMesh mesh = part_of_square(30, [](double x, double y) {
    return limb_and_hand(x, y) && !(x > 13 && x < 15 && y > 14 && y < 16) &&
           !(x > 17 && x < 18 && y > 14 && y < 15);
  });
  ASSERT_EQ(topology(mesh).betti, (BettiNumbers{1, 2, 0}));
  put_curves(mesh, std::vector{line(11, 21, 3)}, everywhere);
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
}

TEST(RoundSheet, KeepsTheTunnelOfALoop) {
  // Two limbs from a body to another: one becomes a curve.
  SheetMesh mesh = part_of_square(30, [](double x, double y) { return limb_and_hand(x, y) || y < 4; });
  ASSERT_EQ(topology(mesh).betti, (BettiNumbers{1, 1, 0}));
  for (const double radius : {3.0, 9.0}) {  // also where the limb is no longer than its radius
    SheetMesh copy = mesh;
    EXPECT_EQ(put_curves(copy, std::vector{line(11, 21, radius)}, everywhere), 1U);
    EXPECT_EQ(topology(copy).betti, (BettiNumbers{1, 1, 0}));
  }
}

TEST(RoundSheet, AloneBecomesTheCurveAlone) {
  SheetMesh mesh = part_of_square(30, [](double x, double y) { return x > 4 && x < 26 && y > 14 && y < 16; });
  // Its ends reach beyond the curve's by less than a radius.
  put_curves(mesh, std::vector{line(6, 24, 3)}, everywhere);
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_EQ(mesh.vertices.size(), 19U);
  EXPECT_EQ(mesh.segments.size(), 18U);
  EXPECT_EQ(mesh.part.size(), 19U);
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
}

// A ring 2 wide round (15, 15), and the curve of 64 vertices in its middle.
SheetMesh ring() {
  return part_of_square(30, [](double x, double y) {
    const double r = std::max(std::abs(x - 15), std::abs(y - 15));
    return r > 7 && r < 9;
  });
}

RidgeCurve ring_curve() {
  RidgeCurve curve;
  curve.closed = true;
  const auto add = [&](double x, double y) {
    SheetVertex v;
    v.position = {x, y, 0.1};
    curve.vertices.push_back(v);
    curve.radius.push_back(3);
  };
  for (double t = 7; t < 23; t += 1) add(t, 7);
  for (double t = 7; t < 23; t += 1) add(23, t);
  for (double t = 23; t > 7; t -= 1) add(t, 23);
  for (double t = 23; t > 7; t -= 1) add(7, t);
  return curve;
}

TEST(RoundSheet, OfARingIsAClosedCurve) {
  SheetMesh mesh = ring();
  ASSERT_EQ(topology(mesh).betti, (BettiNumbers{1, 1, 0}));
  put_curves(mesh, std::vector{ring_curve()}, everywhere);
  EXPECT_TRUE(mesh.triangles.empty());
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(mesh.segments.size(), 64U);
}

TEST(RoundSheet, StaysWhereItClosesTheGapOfACurve) {
  SheetMesh mesh = ring();
  RidgeCurve open = ring_curve();
  open.closed = false;
  // From the middle of a side to three steps before it.
  std::rotate(open.vertices.begin(), open.vertices.begin() + 8, open.vertices.end());
  open.vertices.resize(61);
  open.radius.resize(61);
  put_curves(mesh, std::vector{open}, everywhere);
  EXPECT_FALSE(mesh.triangles.empty());
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 1, 0}));
}

TEST(RoundSheet, StaysWhereItIsWideOrOfAnotherPart) {
  const SheetMesh whole = square(30, [](double, double) { return 10; });
  SheetMesh mesh = whole;
  EXPECT_EQ(put_curves(mesh, std::vector{line(5, 25, 3)}, everywhere), 0U);
  EXPECT_EQ(mesh.triangles, whole.triangles);
  EXPECT_TRUE(mesh.segments.empty());
  SheetMesh limb = part_of_square(30, limb_and_hand);
  RidgeCurve other = line(11, 21, 3);
  other.part = 1;
  EXPECT_EQ(put_curves(limb, std::vector{other}, everywhere), 0U);
  // A stretch shorter than its radius is none.
  EXPECT_EQ(put_curves(limb, std::vector{line(14, 16, 3)}, everywhere), 0U);
}

}  // namespace
}  // namespace affskel::core

#include "core/chords/chord_shocks.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/chords/chord_fields.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

constexpr std::array<Vec3, 3> kUnitAxes{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};

// E = min(1 + z, 8.6 - z): equal at z = 3.8, where E = 4.8.
TEST(ChordShocks, OppositeSlopesCrossOnOneLayerOfEdges) {
  const BoxLattice box(9, 9, 9);
  const FrameField field =
      field_of_branches(box.lattice, {linear_branch(1, {0, 0, 1}), linear_branch(8.6, {0, 0, -1})});
  const std::vector<ChordShock> shocks = chord_shocks(box.lattice, field);
  ASSERT_EQ(shocks.size(), 81U);
  for (const ChordShock& shock : shocks) {
    EXPECT_EQ(shock.axis, 2);
    EXPECT_EQ(shock.place[2], 3U);
    EXPECT_EQ(shock.upper, shock.point + 1);
    EXPECT_NEAR(shock.t, 0.8, 1e-12);
    EXPECT_NEAR(shock.position.z, 3.8, 1e-12);
    EXPECT_EQ(shock.position.x, shock.place[0]);
    EXPECT_NEAR(shock.erosion, 4.8, 1e-12);
    EXPECT_EQ(shock.strength, 1);
    EXPECT_EQ(shock.opening, 1);
    EXPECT_EQ(shock.direction_low, 0U);
    EXPECT_EQ(shock.direction_high, 1U);
  }
}

// Two linear functions are equal on a plane; every edge whose ends lie on its two sides crosses it there.
TEST(ChordShocks, ASlantingPlaneIsMetOnEveryEdgeAcrossIt) {
  const BoxLattice box(7, 8, 9);
  const Vec3 a{1.3, 0.4, 2.1}, b{-0.9, -1.1, -0.3};
  const FrameField field = field_of_branches(box.lattice, {linear_branch(0.2, a), linear_branch(18.9, b)});
  std::size_t across = 0;
  for (const AxisRuns& axis : box.lattice.axis) {
    for (const LatticeRun& run : axis.runs) {
      for (std::uint32_t n = run.first; n + 1 < run.first + run.length; ++n) {
        const std::uint32_t x = axis.order.empty() ? n : axis.order[n];
        const std::uint32_t y = axis.order.empty() ? n + 1 : axis.order[n + 1];
        across += field.direction[x] != field.direction[y] ? 1 : 0;
      }
    }
  }
  ChordConstants constants;
  constants.min_strength = 0;
  const std::vector<ChordShock> shocks = chord_shocks(box.lattice, field, constants);
  EXPECT_GT(across, 100U);
  ASSERT_EQ(shocks.size(), across);
  for (std::size_t s = 0; s < shocks.size(); ++s) {
    EXPECT_NEAR(0.2 + dot(a, shocks[s].position), 18.9 + dot(b, shocks[s].position), 1e-11);
    EXPECT_NEAR(shocks[s].erosion, 0.2 + dot(a, shocks[s].position), 1e-11);
    EXPECT_NEAR(shocks[s].opening, 0.5 * (1 - dot(a, b) / (norm(a) * norm(b))), 1e-12);
    if (s > 0) {
      EXPECT_TRUE(shocks[s - 1].point < shocks[s].point ||
                  (shocks[s - 1].point == shocks[s].point && shocks[s - 1].axis < shocks[s].axis));
    }
  }
}

// Branches that bend: a quarter of a step off at most, and exact where both bend alike.
TEST(ChordShocks, BentBranchesAreMetToSecondOrder) {
  const BoxLattice box(5, 5, 9);
  const auto branch = [](double sign, double bend) {
    return Branch{[=](const Vec3& u) { return 10 + sign * (u.z - 4.3) + bend * (u.z - 4.3) * (u.z - 4.3); },
                  [=](const Vec3& u) {
                    return Vec3{0, 0, sign + 2 * bend * (u.z - 4.3)};
                  }};
  };
  for (double bend : {-0.2, -0.05, 0.05, 0.2}) {
    const FrameField field = field_of_branches(box.lattice, {branch(1, bend), branch(-1, bend)});
    const std::vector<ChordShock> shocks = chord_shocks(box.lattice, field);
    ASSERT_EQ(shocks.size(), 25U);
    // Tangents at distances 0.3 and 0.7 give errors of at most bend (0.7^2 - 0.3^2) / 2.
    for (const ChordShock& shock : shocks) EXPECT_NEAR(shock.position.z, 4.3, std::abs(bend) * 0.2 + 0.02);
  }
}

TEST(ChordShocks, AValleyIsNoShock) {
  const BoxLattice box(4, 4, 8);
  FrameField field = field_of_branches(box.lattice, {linear_branch(9, {0, 0, -1})});
  for (std::uint32_t p = 0; p < box.lattice.points; ++p) {
    if (p % 8 < 4) continue;
    field.direction[p] = 1;
    field.erosion[p] = 2 + p % 8;
    field.gradient[p] = {0, 0, 1};
  }
  EXPECT_TRUE(chord_shocks(box.lattice, field).empty());
}

// A jump of E is no shock either: the branches would be equal far outside the edge.
TEST(ChordShocks, SlackDecidesHowFarOutsideTheBranchesMayMeet) {
  const BoxLattice box(3, 3, 6);
  for (const double beyond : {0.1, 0.2, 0.3, 3.0}) {
    FrameField field = field_of_branches(box.lattice, {linear_branch(1, {0, 0, 1})});
    for (std::uint32_t p = 0; p < box.lattice.points; ++p) {
      if (p % 6 < 3) continue;
      // Equal at z = 3 + beyond.
      field.direction[p] = 1;
      field.erosion[p] = 1 + 2 * (3 + beyond) - p % 6;
      field.gradient[p] = {0, 0, -1};
    }
    const std::vector<ChordShock> shocks = chord_shocks(box.lattice, field);
    ASSERT_EQ(shocks.size(), beyond < 0.25 ? 9U : 0U) << beyond;
    for (const ChordShock& shock : shocks) {
      EXPECT_EQ(shock.t, 1);
      EXPECT_EQ(shock.position.z, 3);
      EXPECT_EQ(shock.erosion, field.erosion[shock.upper]);
    }
  }
}

TEST(ChordShocks, BoundsOnStrengthAndOpeningHold) {
  const BoxLattice box(4, 4, 9);
  // Normals 2 * 30 degrees apart, opening 1/4; along z both rise, r = (2 - 1) / (2 + 1).
  const FrameField wedge = field_of_branches(
      box.lattice, {linear_branch(0, {std::sqrt(3.0), 0, 1}), linear_branch(9, {std::sqrt(3.0), 0, -1})});
  const FrameField slope =
      field_of_branches(box.lattice, {linear_branch(0, {0, 0, 2}), linear_branch(4.5, {0, 1, 1})});
  ChordConstants constants;
  constants.min_opening = 0.249;
  EXPECT_EQ(chord_shocks(box.lattice, wedge, constants).size(), 16U);
  constants.min_opening = 0.251;
  EXPECT_TRUE(chord_shocks(box.lattice, wedge, constants).empty());
  constants.min_opening = 0.01;
  for (const ChordShock& shock : chord_shocks(box.lattice, slope, constants)) {
    if (shock.axis == 2) {
      EXPECT_NEAR(shock.strength, 1.0 / 3, 1e-12);
    }
  }
  constants.min_strength = 0.34;
  for (const ChordShock& shock : chord_shocks(box.lattice, slope, constants)) EXPECT_NE(shock.axis, 2);
}

// Two slabs 0.2 apart between two layers of points: E jumps over the gap, and no segment lies in the solid.
TEST(ChordShocks, NoEdgeAcrossAGap) {
  const BoxLattice slabs(joined(make_box(9, 9, 4.1), moved(make_box(9, 9, 4.7), {0, 0, 4.3})));
  const Lattice& lattice = slabs.lattice;
  ASSERT_EQ(lattice.points, 729U);
  EXPECT_TRUE(chord_shocks(lattice, field_of_branches(
                                        lattice, {linear_branch(1, {0, 0, 1}), linear_branch(8, {0, 0, -1})}))
                  .empty());
  EXPECT_EQ(chord_shocks(lattice, field_of_branches(
                                      lattice, {linear_branch(1, {0, 0, 1}), linear_branch(9.2, {0, 0, -1})}))
                .size(),
            81U);
}

// Where a solid's surface passes through the solid, edges cross it without leaving the solid: the same shocks
// as in the box that the two make up, at both surfaces, along every axis.
TEST(ChordShocks, SurfacesInsideTheSolidAreCrossed) {
  const BoxLattice box(9, 9, 9);
  Mesh mesh = overlapping_boxes(9, 9, 9);
  Vec3 up{0, 0, 1};
  for (const std::size_t axis : {2U, 0U, 1U}) {
    const BoxLattice two(mesh);
    ASSERT_EQ(two.lattice.points, 729U);
    ASSERT_EQ(two.lattice.axis[axis].runs.size(), 3 * 81U);
    for (const double at : {2.2, 5.6}) {  // the surfaces at 2.8 and 6.2, points at 0.5, 1.5 ...
      const std::vector<Branch> branches{linear_branch(20, up), linear_branch(20 + 2 * at, -up)};
      const auto expected = chord_shocks(box.lattice, field_of_branches(box.lattice, branches));
      const auto found = chord_shocks(two.lattice, field_of_branches(two.lattice, branches));
      ASSERT_EQ(expected.size(), 81U);
      ASSERT_EQ(found.size(), expected.size());
      for (std::size_t s = 0; s < found.size(); ++s) {
        EXPECT_EQ(found[s].point, expected[s].point);
        EXPECT_EQ(found[s].axis, axis);
        EXPECT_NEAR(found[s].t, at - std::floor(at), 1e-12);
      }
    }
    for (Vec3& p : mesh.points) p = {p.z, p.x, p.y};
    up = {up.z, up.x, up.y};
  }
}

// The invariance that the header claims: solid and lattice mapped together by a map of determinant 1.
TEST(ChordShocks, AMappedLatticeGivesTheSameNumbers) {
  // Shaken: where directions tie, rounding decides.
  const Mesh torus = shaken(make_torus(3, 1.1, 128), 0.1, 5);
  Mesh mapped = torus;
  const auto map = [](const Vec3& p) { return Vec3{2 * p.x + 0.5 * p.y, p.y, p.z / 2 + 0.25 * p.y}; };
  for (Vec3& p : mapped.points) p = map(p);
  const double h = 0.23;
  const std::array<Vec3, 3> axes{h * kUnitAxes[0], h * kUnitAxes[1], h * kUnitAxes[2]};
  const ErodedSolid a(torus, axes, "triangles");
  const ErodedSolid b(mapped, {map(axes[0]), map(axes[1]), map(axes[2])}, "triangles");
  const std::vector<ChordShock> of_a = chord_shocks(a.lattice, a.field),
                                of_b = chord_shocks(b.lattice, b.field);
  ASSERT_EQ(a.lattice.points, b.lattice.points);
  EXPECT_GT(of_a.size(), 100U);
  std::size_t equal = 0, i = 0;
  for (const ChordShock& s : of_b) {
    while (i < of_a.size() &&
           (of_a[i].point < s.point || (of_a[i].point == s.point && of_a[i].axis < s.axis)))
      ++i;
    if (i == of_a.size() || of_a[i].point != s.point || of_a[i].axis != s.axis) continue;
    if (of_a[i].direction_low != s.direction_low || of_a[i].direction_high != s.direction_high) continue;
    ++equal;
    EXPECT_NEAR(of_a[i].t, s.t, 1e-6);
    EXPECT_NEAR(of_a[i].strength, s.strength, 1e-6);
    EXPECT_NEAR(of_a[i].opening, s.opening, 1e-6);
    EXPECT_NEAR(of_a[i].erosion, s.erosion, 1e-9 * a.solid.volume);
  }
  EXPECT_GT(equal, of_a.size() * 99 / 100);
}

// The opening across the middle plane z = 0 at the lattice edge over (x, y), both steps of spacing h.
double opening_across_the_middle(const ErodedSolid& solid, double x, double y) {
  ChordConstants constants;
  constants.min_strength = 0;
  constants.min_opening = 0;
  double nearest = 1e300, opening = 0;
  for (const ChordShock& shock : chord_shocks(solid.lattice, solid.field, constants)) {
    const Vec3 p = solid.place(shock.position);
    const double away = std::hypot(p.x - x, p.y - y);
    if (shock.axis != 2 || std::abs(p.z) > 1e-6 || away >= nearest) continue;
    nearest = away;
    opening = shock.opening;
  }
  return opening;
}

// No shock in the middle of a box: seen by ever more directions, its E is smooth there, as the depth of every
// symmetric body is.  Near an upright edge, a and b from the two faces, the upright cut 2 a b c is the strict
// least of all through a point of the middle plane: turning it to tan = k about any axis in it adds a volume
// of the order of k^2.  So the normals on both sides draw together as the lattice is refined; at a torus's
// sheet they keep their angle.
TEST(ChordShocks, TheMiddleOfABoxIsNoneButThatOfATorusIs) {
  const Mesh box = moved(make_box(3, 2, 1), {-1.5, -1, -0.5}), torus = make_torus(3, 1, 1024);
  std::vector<double> near_centre, near_edge, in_torus;
  for (const double h : {0.2, 0.1, 0.05}) {
    const ErodedSolid a(box, {h * kUnitAxes[0], h * kUnitAxes[1], 1.25 * h * kUnitAxes[2]}, "sphere:8000");
    near_centre.push_back(opening_across_the_middle(a, 0.4, 0.2));
    near_edge.push_back(opening_across_the_middle(a, 1.2, 0.7));
    const ErodedSolid b(torus, {2 * h * kUnitAxes[0], 2 * h * kUnitAxes[1], h * kUnitAxes[2]}, "triangles");
    in_torus.push_back(opening_across_the_middle(b, 2.4, 0));
  }
  EXPECT_GT(in_torus[0], 0.3);
  for (std::size_t k = 1; k < 3; ++k) {
    EXPECT_LT(near_centre[k], 0.7 * near_centre[k - 1]);
    EXPECT_LT(near_edge[k], 0.7 * near_edge[k - 1]);
    EXPECT_NEAR(in_torus[k], in_torus[0], 0.05);
  }
}

}  // namespace
}  // namespace affskel::core

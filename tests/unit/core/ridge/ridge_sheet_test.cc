#include "core/ridge/ridge_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/chords/chord_fields.h"
#include "core/collapse/lattice_solids.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/edges.h"
#include "core/mesh/perturb.h"
#include "core/mesh/polylines.h"
#include "core/ridge/sheet_solids.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid_membership.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Closed curves that the edges of one triangle form; no edge may have three.
std::size_t rim_loops(const RidgeSheet& sheet) {
  std::vector<Segment> rim;
  Edges(sheet.vertices.size(), sheet.triangles)
      .for_each([&](std::uint32_t low, std::uint32_t high, std::span<const EdgeSide> sides) {
        EXPECT_LE(sides.size(), 2U);
        if (sides.size() == 1) rim.push_back({low, high});
      });
  return polylines(sheet.vertices.size(), rim).size();
}

struct Range {
  double low = 1e300, high = -1e300;
  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

// The torus of the published experiments, finer: its skeleton is the annulus in its middle plane, from the
// inner surface outwards: E is large there, and the sheet keeps off it.
TEST(RidgeSheet, OfATorusIsAnAnnulusOffTheInnerSurface) {
  const double h = 2.0 / 12;
  const ErodedSolid torus(make_torus(3, 1, 1024), axes(h), "triangles");
  const RidgeSheet sheet = ridge_of(torus);
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(rim_loops(sheet), 2U);
  EXPECT_TRUE(sheet.segments.empty());
  Range r;
  for (const SheetVertex& v : sheet.vertices) {
    const Vec3 x = torus.place(v.position);
    EXPECT_NEAR(x.z, 0, 0.05 * h);
    r.take(std::hypot(x.x, x.y));
    EXPECT_GE(v.strength, 6);
    // The level surfaces are mirror images of each other in the plane, and lean to its two sides.
    EXPECT_NEAR(std::abs(v.normal_a.z), std::abs(v.normal_b.z), 0.02);
    EXPECT_LT(v.normal_a.z * v.normal_b.z, 0);
    EXPECT_NEAR(norm(v.normal_a), 1, 1e-12);
  }
  EXPECT_GT(r.low, 2 + 0.5 * h);
  EXPECT_LT(r.low, 2 + 2 * h);
  EXPECT_GT(r.high, 2.5);
  EXPECT_LT(r.high, 3);
}

// Noise makes crests of E along the inner wall, where E is large: the skeleton has none of them.
TEST(RidgeSheet, OfANoisyTorusKeepsOffTheInnerSurface) {
  const double h = 0.09;
  const ErodedSolid torus(perturb(make_torus(3, 1, 2048), {.sigma = 0.03}), axes(h), "triangles");
  const RidgeSheet sheet = ridge_of(torus);
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 1, 0}));
  for (const SheetVertex& v : sheet.vertices) EXPECT_NEAR(torus.place(v.position).z, 0, h);
}

// A plate in the plane z = 0 with a hole, of which noise makes crests along the wall of the hole and the rounded edges.
TEST(RidgeSheet, OfANoisyPlateWithAHoleLiesInItsMiddle) {
  const auto plate = [](const Vec3& p) {
    const Vec3 beyond{std::max(0.0, std::abs(p.x) - 0.5), std::max(0.0, std::abs(p.y) - 0.5),
                      std::max(0.0, std::abs(p.z) - 0.1)};
    return std::max(norm(beyond) - 0.1, 0.2 - std::hypot(p.x, p.y));
  };
  const double h = 0.02;
  const Mesh mesh = mesh_zero_set(plate, {{-0.7, -0.7, -0.3}, {0.7, 0.7, 0.3}, 0.05});
  const ErodedSolid noisy(perturb(mesh, {.sigma = 0.01, .seed = 2}), axes(h), "sphere:500");
  ASSERT_TRUE(noisy.solid.self_intersecting);
  const RidgeSheet sheet = ridge_of(noisy);
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 1, 0}));
  for (const SheetVertex& v : sheet.vertices) EXPECT_NEAR(noisy.place(v.position).z, 0, h);
}

// In the middle of a flat box two opposite chords are equal.
TEST(RidgeSheet, OfAFlatBoxIsTheMiddleRectangleAtEverySpacing) {
  for (const double h : {6.0 / 32, 6.0 / 45}) {
    const ErodedSolid box(make_box(6, 3, 1, 1), axes(h), "sphere:1280");
    const RidgeSheet sheet = ridge_of(box);
    EXPECT_EQ(topology(sheet), (BettiNumbers{1, 0, 0})) << h;
    EXPECT_TRUE(sheet.segments.empty());
    Range x, y;
    for (const SheetVertex& v : sheet.vertices) {
      const Vec3 at = box.place(v.position);
      x.take(at.x);
      y.take(at.y);
      EXPECT_NEAR(at.z, 0.5, 0.02 * h);
      EXPECT_NEAR(v.normal_a.z, -v.normal_b.z, 0.05);
    }
    EXPECT_NEAR(x.low, 0.6, 0.25) << h;
    EXPECT_NEAR(x.high, 5.4, 0.25) << h;
    EXPECT_NEAR(y.low, 0.6, 0.25) << h;
    EXPECT_NEAR(y.high, 2.4, 0.25) << h;
  }
}

// The level sets of E are balls about one centre: no sheet, but that point.
TEST(RidgeSheet, OfABallIsItsCentre) {
  const double h = 0.125;
  const ErodedSolid ball(make_sphere(1, 320), axes(h), "triangles");
  const RidgeSheet sheet = ridge_of(ball);
  ASSERT_FALSE(sheet.vertices.empty());
  EXPECT_EQ(topology(sheet).components, 1U);
  EXPECT_TRUE(sheet.segments.empty());
  Range across[3];
  for (const SheetVertex& v : sheet.vertices) {
    const Vec3 x = ball.place(v.position);
    for (int k = 0; k < 3; ++k) across[k].take(x[k]);
  }
  for (const Range& range : across) {
    EXPECT_LE(range.high - range.low, 2 * h);
    EXPECT_LE(std::abs(range.high + range.low), h);
  }
}

// No ridge is strong in it.
TEST(RidgeSheet, OfAHollowBallIsASphereInItsMiddle) {
  const double h = 0.2;
  const ErodedSolid ball(joined(make_sphere(3, 1280), reversed(make_sphere(1.5, 320))), axes(h), "sphere:80");
  const RidgeSheet sheet = ridge_of(ball);
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 0, 1}));
  Range r;
  for (const SheetVertex& v : sheet.vertices) r.take(norm(ball.place(v.position)));
  EXPECT_GT(r.low, 2.25 - 1.5 * h);
  EXPECT_LT(r.high, 2.25 + 0.5 * h);
}

// Elliptic sections 1 x 0.5: a strip in the plane of the long axis, round the cylinder's own axis.
TEST(RidgeSheet, OfAnEllipticCylinderIsAStripRoundItsAxis) {
  const double h = 0.1;
  Mesh cylinder = make_cylinder(1, 6, 32);
  for (Vec3& p : cylinder.points) p.y *= 0.5;
  const ErodedSolid solid(cylinder, axes(h), "triangles+sphere:1280");
  const RidgeSheet sheet = ridge_of(solid);
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 0, 0}));
  Range x, z;
  for (const SheetVertex& v : sheet.vertices) {
    const Vec3 at = solid.place(v.position);
    EXPECT_NEAR(at.y, 0, 0.05 * h);
    x.take(at.x);
    z.take(at.z);
  }
  EXPECT_NEAR(x.low, -x.high, 0.5 * h);
  EXPECT_LT(x.high, 0.5);
  EXPECT_LT(z.low, 0.8);
  EXPECT_GT(z.high, 5.2);
}

// All vertices of a sheet within `reach` of the z axis, and in one piece without triangles, from low to high.
void expect_axis(const ErodedSolid& solid, const RidgeSheet& sheet, double reach, double low, double high) {
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 0, 0}));
  EXPECT_TRUE(sheet.triangles.empty());
  EXPECT_EQ(sheet.segments.size() + 1, sheet.vertices.size());
  Range z;
  for (const SheetVertex& v : sheet.vertices) {
    const Vec3 at = solid.place(v.position);
    EXPECT_LT(std::hypot(at.x, at.y), reach);
    EXPECT_GE(v.strength, v.kind == SkeletonKind::kWay ? 0 : 6);
    z.take(at.z);
  }
  EXPECT_LT(z.low, low);
  EXPECT_GT(z.high, high);
}

// E falls alike to all sides of the axis of a round cylinder; so it does in an elliptic one in a frame in
// which it is round, on the same axis.
TEST(RidgeSheet, OfARoundCylinderIsItsAxis) {
  const double h = 0.1;
  const Mesh round = make_cylinder(1, 6, 32);
  const ErodedSolid cylinder(round, axes(h), "triangles+sphere:320");
  const RidgeSheet axis = ridge_of(cylinder);
  expect_axis(cylinder, axis, 0.5 * h, 1, 5);
  // The level plane through a point of the axis cuts off pi z, up to the 32-gon's share; smaller ones meet
  // the sample points beside it, where tilted planes have larger sections.
  for (const SheetVertex& v : axis.vertices) {
    const double z = cylinder.place(v.position).z, level = 3.12 * std::min(z, 6 - z);
    EXPECT_LE(v.erosion, level + 0.01);
    EXPECT_GE(v.erosion, 0.9 * level);
    EXPECT_GE(v.area, 3.1);
  }
  Mesh narrow = round;
  for (Vec3& p : narrow.points) p.y *= 0.5;
  const ErodedSolid elliptic(narrow, axes(h, 1, 0.5, 1), "triangles+sphere:320");
  expect_axis(elliptic, ridge_of(elliptic), 0.5 * h, 1, 5);
}

TEST(RidgeSheet, OfAShortRoundCylinderIsItsAxis) {
  const double h = 0.1;
  const ErodedSolid cylinder(make_cylinder(1, 3, 32), axes(h), "triangles+sphere:1280");
  const RidgeSheet axis = ridge_of(cylinder);
  expect_axis(cylinder, axis, 0.5 * h, 1.2, 1.8);
}

TEST(RidgeSheet, OfAConeIsItsAxis) {
  const double h = 0.1;
  const ErodedSolid cone(make_cone(1, 6, 32), axes(h), "triangles+sphere:320");
  // The way to its tip goes on straight from where it is thinner than the lattice resolves.
  expect_axis(cone, ridge_of(cone), 0.5 * h, 1, 5.4);
}

// A stalk has a ridge, the apple on it none that lasts: what is round on all sides has no direction.
TEST(RidgeSheet, LeadsFromALimbToTheMiddleOfARoundBody) {
  const auto apple = [](const Vec3& p) {
    return std::min(norm(p) - 1, std::max(std::hypot(p.x, p.y) - 0.2, std::abs(p.z - 1.2) - 0.8));
  };
  const double h = 0.1;
  const ErodedSolid solid(mesh_zero_set(apple, {{-1.3, -1.3, -1.3}, {1.3, 1.3, 2.3}, 0.1}), axes(h),
                          "sphere:320");
  const RidgeSheet sheet = ridge_of(solid);
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 0, 0}));
  Range z, off_axis;
  for (const SheetVertex& v : sheet.vertices) {
    const Vec3 at = solid.place(v.position);
    z.take(at.z);
    off_axis.take(std::hypot(at.x, at.y));
  }
  EXPECT_NEAR(z.low, 0, 1.5 * h);
  EXPECT_GT(z.high, 1.6);
  EXPECT_LT(off_axis.high, 2 * h);
}

TEST(RidgeSheet, OfTwoCylindersIsTheAxisOfEach) {
  const Mesh first = make_cylinder(0.5, 6, 32), second = moved(first, {2.5, 0, 0});
  const ErodedSolid both(joined(first, second), axes(0.1), "triangles+sphere:320");
  const RidgeSheet sheet = ridge_of(both);
  EXPECT_EQ(topology(sheet), (BettiNumbers{2, 0, 0}));
  EXPECT_TRUE(sheet.triangles.empty());
}

// E is greatest on a sphere, whose normals have all directions: eigenvectors of any sign make one closed
// sheet.
TEST(RidgeSheet, IsClosedWhereEIsGreatestOnASphere) {
  const BoxLattice box(23, 23, 23);  // so large that the sphere is not too near to its surface
  const Vec3 centre{11.1, 10.9, 11.05};
  const double radius = 5.5;
  const Branch shell{[&](const Vec3& u) {
                       const double off = norm(u - centre) - radius;
                       return 100 - off * off;
                     },
                     [&](const Vec3& u) {
                       const double r = norm(u - centre);
                       return (-2 * (r - radius) / r) * (u - centre);
                     }};
  const FrameField field = field_of_branches(box.lattice, {shell});
  RidgeBasis basis = ridge_basis(box.solid, box.lattice, field);
  basis.derivatives = smoothed_derivatives(box.lattice, field, 1, nullptr, {.least = 1, .greatest = 1});
  const RidgeSheet sheet = ridge_sheet(box.solid, box.lattice, field, basis);
  // The box has no void: the pocket is opened, at one square.
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(sheet.opened, 1U);
  EXPECT_EQ(rim_loops(sheet), 1U);
  // Smoothing a curved crest draws it in by about width^2 / radius.
  for (const SheetVertex& v : sheet.vertices) EXPECT_NEAR(norm(v.position - centre), radius, 0.3);
}

// Whatever the field says, the skeleton has the pieces, tunnels and voids of the lattice's complex.
TEST(RidgeSheet, HasTheTopologyOfTheLattice) {
  std::vector<Mesh> meshes{hollow_ball(),
                           joined(make_torus(3, 1, 256), moved(make_torus(3, 1, 256), {5, 0, 0}))};
  for (std::uint64_t seed = 0; seed < 20; ++seed) meshes.push_back(random_solid(seed));
  for (std::size_t n = 0; n < meshes.size(); ++n) {
    const ErodedSolid solid(meshes[n], axes(n < 2 ? 0.4 : 0.13), "sphere:80");
    const RidgeSheet sheet = ridge_of(solid);
    BettiNumbers expected = sheet.lattice;
    expected.components -= sheet.fragments;
    EXPECT_EQ(topology(sheet), expected) << n;
    const SolidMembership membership(solid.solid.mesh);
    for (const SheetVertex& v : sheet.vertices) {
      EXPECT_GE(v.erosion, 0);
      EXPECT_TRUE(
          membership.contains(scaled_place(solid.lattice, (1 / solid.lattice.spacing) * v.position), 1e-9));
    }
  }
}

// Strengths are angles and widths go with the depth: a mesh twice as large with twice the spacing is the
// same.
TEST(RidgeSheet, HasNoUnitOfLength) {
  const Mesh box = make_box(4, 2, 1, 1);
  const ErodedSolid one(box, axes(0.2), "sphere:320"),
      eight(moved(box, {0, 0, 0}, 8), axes(1.6), "sphere:320");
  const RidgeSheet small = ridge_of(one), large = ridge_of(eight);
  ASSERT_EQ(small.triangles, large.triangles);
  for (std::size_t v = 0; v < small.vertices.size(); ++v) {
    EXPECT_NEAR(norm(8 * small.vertices[v].position - large.vertices[v].position), 0, 1e-4);
    EXPECT_NEAR(small.vertices[v].strength, large.vertices[v].strength, 1e-3 * large.vertices[v].strength);
  }
}

// Two solids beside each other have the sheets that they would have alone.
TEST(RidgeSheet, OfTwoSolidsIsThatOfEach) {
  const Mesh box = make_box(4, 2, 1, 1);
  const ErodedSolid both(joined(box, moved(box, {0, 0, 1.4})), axes(0.2), "sphere:320");
  const RidgeSheet sheet = ridge_of(both);
  EXPECT_EQ(topology(sheet), (BettiNumbers{2, 0, 0}));
  EXPECT_EQ(sheet.lattice, (BettiNumbers{2, 0, 0}));
}

TEST(RidgeSheet, OfABasisIsTheSameAtEveryThresholdAndNumberOfThreads) {
  const ErodedSolid box(make_box(4, 2, 1, 1), axes(0.125), "sphere:320");
  const RidgeBasis basis = ridge_basis(box.solid, box.lattice, box.field, 2);
  for (const double share : {1.0, 1.5}) {
    RidgeSheetOptions options;
    options.bounds.low *= share;
    options.bounds.high *= share;
    const RidgeSheet expected = ridge_of(box, options);
    const RidgeSheet found = ridge_sheet(box.solid, box.lattice, box.field, basis, options);
    ASSERT_FALSE(found.triangles.empty());
    EXPECT_EQ(found.triangles, expected.triangles);
    EXPECT_EQ(found.segments, expected.segments);
    ASSERT_EQ(found.vertices.size(), expected.vertices.size());
    for (std::size_t v = 0; v < found.vertices.size(); ++v) {
      EXPECT_EQ(found.vertices[v].position, expected.vertices[v].position);
      EXPECT_EQ(found.vertices[v].strength, expected.vertices[v].strength);
    }
  }
  const ErodedSolid other(make_box(4, 2, 1, 1), axes(0.25), "sphere:80");
  EXPECT_THROW(ridge_sheet(other.solid, other.lattice, other.field, basis), CoreError);
}

TEST(RidgeSheet, TellsTheStrongestRidgeBelowItsThreshold) {
  const ErodedSolid torus(make_torus(3, 1, 1024), axes(2.0 / 12), "triangles");
  const double strongest = ridge_of(torus).strongest;
  EXPECT_GT(strongest, 0);
  for (const double times : {2., 7., 9.}) {
    RidgeSheetOptions options;
    options.bounds = {times * strongest, times * strongest};
    EXPECT_EQ(ridge_of(torus, options).strongest, times * RidgeConstants::weak_share < 1 ? strongest : 0)
        << times;
  }
}

// Of a rod with a ball's halves at its ends, drawn out; what is not told keeps its place.
TEST(RidgeSheet, HasLinesThatLeadToTheTips) {
  const auto rod = [](const Vec3& p) { return norm(p - Vec3{0, 0, std::clamp(p.z, -4.0, 4.0)}) - 1; };
  const double h = 0.2;
  const ErodedSolid solid(mesh_zero_set(rod, {{-1.5, -1.5, -5.5}, {1.5, 1.5, 5.5}, 0.3}), axes(h),
                          "sphere:320");
  const RidgeSheet before = ridge_of(solid);
  RidgeSheet sheet = before;
  draw_out(sheet);
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 0, 0}));
  Range z;
  for (std::size_t v = 0; v < sheet.vertices.size(); ++v) {
    const Vec3 at = solid.place(sheet.vertices[v].position);
    z.take(at.z);
    if (std::abs(at.z) < 2) {
      EXPECT_EQ(sheet.vertices[v].position, before.vertices[v].position);
    }
  }
  EXPECT_NEAR(z.low, -4.5, h);
  EXPECT_NEAR(z.high, 4.5, h);
  for (const auto& [v, vertex] : sheet.drawn_out) {
    const Vec3 at = solid.place(vertex.position);
    const double height = 5 - std::abs(at.z), cap = std::numbers::pi * height * height * (3 - height) / 3;
    if (height < 0.7) {
      EXPECT_NEAR(vertex.erosion, cap, 0.15);
    }
    const auto places = lattice_places(solid.lattice, std::vector{vertex.point});
    EXPECT_LT(norm(h * vector_of(places[0]) - vertex.position), h);
    EXPECT_LT(std::hypot(at.x, at.y), h);
  }
}

TEST(RidgeSheet, StopsWhenItsContextAsks) {
  const ErodedSolid box(make_box(4, 2, 1, 1), axes(0.25), "sphere:80");
  struct Stopped : ExecutionContext {
    bool stop_requested() override { return true; }
  } context;
  RidgeSheetOptions options;
  options.context = &context;
  try {
    ridge_of(box, options);
    FAIL() << "not stopped";
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kCancelled);
  }
}

}  // namespace
}  // namespace affskel::core

#include "core/curve/curve_skeleton.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/collapse/lattice_solids.h"
#include "core/curve/curved.h"
#include "core/curve/tubes.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/polylines.h"
#include "core/quality/sheet_topology.h"
#include "core/shapes/body.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"
#include "core/solid/betti_numbers.h"
#include "core/solid/solid_frame.h"
#include "core/solid/solid_membership.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

BettiNumbers betti(const SheetMesh& curve) {
  return sheet_betti_numbers(mesh_of(curve), curve.segments);
}

double length_of(const SheetMesh& curve) {
  double sum = 0;
  for (const auto& [a, b] : curve.segments)
    sum += norm(curve.vertices[a].position - curve.vertices[b].position);
  return sum;
}

// E is least at the ends, the volume beyond grows along the axis, the distance is that to the wall or the end.
TEST(CurveSkeleton, OfACylinderIsItsAxis) {
  const double h = 0.1;
  const Curved cylinder(make_cylinder(1, 6, 32), h, "triangles+sphere:320");
  const CurveSkeleton curve = cylinder.at();
  EXPECT_EQ(betti(curve), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(curve.branches, 1U);
  EXPECT_EQ(curve.ends, 2U);
  EXPECT_TRUE(curve.triangles.empty());
  double low = 6, high = 0;
  for (std::size_t v = 0; v < curve.vertices.size(); ++v) {
    const Vec3 at = cylinder.place(curve.vertices[v]);
    EXPECT_LT(std::hypot(at.x, at.y), 0.5 * h);
    EXPECT_NEAR(curve.distance[v], std::min({std::cos(std::numbers::pi / 32), at.z, 6 - at.z}), 0.5 * h);
    const double end = std::min(at.z, 6 - at.z);
    if (end > 1.2) {
      EXPECT_NEAR(curve.beyond[v], end / 6, 1.5 * h / 6);
    }
    low = std::min(low, at.z);
    high = std::max(high, at.z);
  }
  EXPECT_LT(low, 1);
  EXPECT_GT(high, 5);
  EXPECT_NEAR(length_of(curve), high - low, 0.5 * h);
}

TEST(CurveSkeleton, OfATorusIsACircle) {
  const double h = 2.0 / 12;
  const Curved torus(make_torus(3, 1, 1024), h, "triangles");
  const CurveSkeleton curve = torus.at();
  EXPECT_EQ(betti(curve), (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(curve.branches, 1U);
  EXPECT_EQ(curve.ends, 0U);
  double mean = 0;
  for (std::size_t v = 0; v < curve.vertices.size(); ++v) {
    const Vec3 at = torus.place(curve.vertices[v]);
    EXPECT_NEAR(at.z, 0, 0.1 * h);
    mean += std::hypot(at.x, at.y) / static_cast<double>(curve.vertices.size());
    EXPECT_LT(curve.beyond[v], 0.05);  // a loop is not parted
  }
  EXPECT_NEAR(length_of(curve), 2 * std::numbers::pi * mean, 2 * h);
}

TEST(CurveSkeleton, OfABallIsAPlace) {
  const Curved ball(make_sphere(1, 320), 0.1, "sphere:320");
  const CurveSkeleton curve = ball.at();
  ASSERT_EQ(curve.vertices.size(), 1U);
  EXPECT_TRUE(curve.segments.empty());
  EXPECT_LT(norm(ball.place(curve.vertices[0])), 0.15);
  EXPECT_NEAR(curve.beyond[0], 0.5, 1e-9);
}

// The closed sheet round a cavity has no line.  The cavity, of radius 1 in 3, lies nearest to the surface at x = 3.
TEST(CurveSkeleton, OfAHollowBallIsOpenedWhereItIsThinnest) {
  const Curved ball(hollow_ball(), 0.4, "sphere:80");
  ASSERT_EQ(ball.ridge().lattice.cavities, 1U);
  const CurveSkeleton curve = ball.at();
  ASSERT_EQ(curve.opened.size(), 1U);
  const Vec3 at = ball.solid().place(curve.opened[0].place);
  EXPECT_LT(norm(at - Vec3{2.25, 0, 0}), 0.8);
  EXPECT_NEAR(curve.opened[0].distance, std::min(norm(at - Vec3{0.5, 0, 0}) - 1, 3 - norm(at)), 0.05);
  EXPECT_EQ(betti(curve), (BettiNumbers{1, 0, 0}));
}

// A ring with a web across it, 0.04 thick, which no sample point lies in.
Mesh webbed_ring() {
  constexpr std::uint32_t kSteps = 48;
  const std::vector<std::array<double, 2>> profile{{0.9, 0.02}, {1, 0.3},  {1.5, 0.3},
                                                   {1.5, -0.3}, {1, -0.3}, {0.9, -0.02}};
  Mesh mesh{{{0, 0, 0.02}, {0, 0, -0.02}}, {}};
  const auto rows = static_cast<std::uint32_t>(profile.size());
  const auto at = [&](std::uint32_t row, std::uint32_t step) { return 2 + row * kSteps + step % kSteps; };
  for (const auto& [r, z] : profile)
    for (std::uint32_t n = 0; n < kSteps; ++n) {
      const double angle = 2 * std::numbers::pi * n / kSteps;
      mesh.points.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
  for (std::uint32_t n = 0; n < kSteps; ++n) {
    mesh.triangles.push_back({0, at(0, n), at(0, n + 1)});
    mesh.triangles.push_back({1, at(rows - 1, n + 1), at(rows - 1, n)});
    for (std::uint32_t row = 0; row + 1 < rows; ++row) {
      mesh.triangles.push_back({at(row, n), at(row + 1, n), at(row + 1, n + 1)});
      mesh.triangles.push_back({at(row, n), at(row + 1, n + 1), at(row, n + 1)});
    }
  }
  return mesh;
}

TEST(CurveSkeleton, HasNoLoopRoundAWebThinnerThanTheSpacing) {
  const Curved ring(webbed_ring(), 0.15, "triangles");
  ASSERT_EQ(betti_numbers(ring.solid().solid), (BettiNumbers{1, 0, 0}));
  ASSERT_EQ(ring.ridge().filled.edges.size(), 1U) << "the lattice has the loop";
  EXPECT_EQ(betti(ring.at()), (BettiNumbers{1, 0, 0}));
}

// A flat ball with a web 0.04 thick between two fingers, which are joined at their tips; `arm` long on the other side.
Mesh mitten(double arm) {
  Mesh mesh = make_sphere(1, 5120);
  for (Vec3& p : mesh.points) {
    const bool is_web = p.x > -0.3 && std::abs(p.y) < 0.25;
    p = {(p.x < -0.3 ? arm * (p.x + 0.3) - 0.6 : 2 * p.x), p.y,
         p.z * (!is_web     ? 0.4
                : p.x < 0.6 ? 0.02
                            : 0.25)};
  }
  return mesh;
}

TEST(CurveSkeleton, KeepsFingersThatTheLatticeJoinsAtTheirTips) {
  const Curved solid(mitten(2), 0.097, "triangles");
  ASSERT_EQ(solid.ridge().filled.edges.size(), 1U);
  const CurveSkeleton curve = solid.at();
  EXPECT_EQ(betti(curve), (BettiNumbers{1, 0, 0}));
  double left = 0, right = 0;
  for (const SheetVertex& vertex : curve.vertices) {
    const Vec3 at = solid.place(vertex);
    if (at.y > 0.25) left = std::max(left, at.x);
    if (at.y < -0.25) right = std::max(right, at.x);
  }
  EXPECT_GT(left, 0.8);
  EXPECT_GT(right, 0.8);
}

// The loop of the fingers ends no line that the solid is thinned to.
TEST(CurveSkeleton, AnArmIsAsLongWhetherTheLatticeJoinsItsFingers) {
  const Curved solid(mitten(12), 0.097, "triangles");
  ASSERT_EQ(solid.ridge().filled.edges.size(), 1U);
  const CurveSkeleton curve = solid.at(4);
  EXPECT_EQ(curve.ends, 2U);
  double low = 0, high = 0;
  for (const SheetVertex& vertex : curve.vertices) {
    low = std::min(low, solid.place(vertex).x);
    high = std::max(high, solid.place(vertex).x);
  }
  EXPECT_LT(low, -6);
  EXPECT_GT(high, 0.5);
}

// Rods one thick along the twelve edges of a cube of edge 4.  No ridge is found in them, and the middle lies between points.
TEST(CurveSkeleton, OfAFrameIsALineInEachRod) {
  const auto frame = [](const Vec3& p) {
    const double x = std::abs(p.x) - 2, y = std::abs(p.y) - 2, z = std::abs(p.z) - 2;
    const auto rod = [](double along, double u, double v) {
      return std::max({along, std::abs(u), std::abs(v)}) - 0.5;
    };
    return std::min({rod(x, y, z), rod(y, z, x), rod(z, x, y)});
  };
  const Curved solid(mesh_zero_set(frame, {.low = {-3, -3, -3}, .high = {3, 3, 3}, .spacing = 0.25}), 0.13,
                     "sphere:200");
  const CurveSkeleton curve = solid.at();
  const auto lines = polylines(curve.vertices.size(), curve.segments);
  EXPECT_EQ(lines.size(), 12U);
  std::vector<std::size_t> ends(curve.vertices.size(), 0);
  for (const auto& line : lines) {
    double length = 0;
    for (std::size_t n = 1; n < line.size(); ++n)
      length += norm(curve.vertices[line[n]].position - curve.vertices[line[n - 1]].position);
    EXPECT_NEAR(length, 4, 0.3);
    ++ends[line.front()];
    ++ends[line.back()];
  }
  EXPECT_EQ(std::count(ends.begin(), ends.end(), 3), 8);
}

TEST(CurveSkeleton, HasThePiecesAndTunnelsOfTheRidge) {
  for (std::uint64_t seed = 0; seed < 25; ++seed) {
    const Curved solid(random_solid(seed), 0.13, "sphere:80");
    const CurveSkeleton curve = solid.at();
    const BettiNumbers found = betti(curve), ridge = solid.ridge().lattice;
    EXPECT_EQ(found.components + solid.ridge().fragments, ridge.components) << seed;
    EXPECT_EQ(found.holes, ridge.holes) << seed;
    const SolidMembership membership(solid.solid().solid.mesh);
    const Lattice& lattice = solid.solid().lattice;
    for (const SheetVertex& v : curve.vertices)
      EXPECT_TRUE(membership.contains(scaled_place(lattice, (1 / lattice.spacing) * v.position), 1e-9));
    double weight = 0;
    for (const std::uint32_t vertex : curve.nearest) ASSERT_LT(vertex, curve.vertices.size());
    for (const double share : curve.share) weight += share;
    EXPECT_NEAR(weight, 1, 1e-9);
  }
}

// Head, hands and feet at least; of a higher threshold fewer, and no others.
TEST(CurveSkeleton, OfABodyHasAnEndInEveryLimb) {
  const Mesh mesh = make_body({.triangles = 1000});
  Vec3 low = mesh.points[0], high = mesh.points[0];
  for (const Vec3& p : mesh.points) {
    low = {std::min(low.x, p.x), 0, std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), 0, std::max(high.z, p.z)};
  }
  const double height = high.z - low.z;
  const Curved body(mesh, height / 150, "triangles");
  const auto ends_at = [&](double least_reach) {
    const CurveSkeleton curve = body.at(least_reach);
    EXPECT_EQ(betti(curve), (BettiNumbers{1, 0, 0}));
    std::vector<int> degree(curve.vertices.size(), 0);
    for (const Segment& segment : curve.segments)
      for (const std::uint32_t v : segment) ++degree[v];
    std::vector<Vec3> ends;
    for (std::size_t v = 0; v < degree.size(); ++v)
      if (degree[v] == 1) ends.push_back(body.place(curve.vertices[v]));
    EXPECT_EQ(ends.size(), curve.ends);
    return ends;
  };
  const auto near = [&](const std::vector<Vec3>& ends, double x, double z) {
    return std::any_of(ends.begin(), ends.end(),
                       [&](const Vec3& at) { return std::hypot(at.x - x, at.z - z) < 0.1 * height; });
  };
  const std::vector<Vec3> all = ends_at(0.9), long_ones = ends_at(4);
  const double foot = 0.1 * height;
  for (const std::vector<Vec3>* ends : {&all, &long_ones}) {
    EXPECT_TRUE(near(*ends, foot, low.z));
    EXPECT_TRUE(near(*ends, -foot, low.z));
    EXPECT_TRUE(std::any_of(ends->begin(), ends->end(),
                            [&](const Vec3& at) { return high.x - at.x < 0.06 * height; }));
    EXPECT_TRUE(std::any_of(ends->begin(), ends->end(),
                            [&](const Vec3& at) { return at.x - low.x < 0.06 * height; }));
  }
  EXPECT_TRUE(near(all, 0, high.z - 0.08 * height));
  EXPECT_GE(all.size(), 5U);
  EXPECT_EQ(long_ones.size(), 4U);
  for (const Vec3& end : long_ones)
    EXPECT_TRUE(std::any_of(all.begin(), all.end(),
                            [&](const Vec3& other) { return norm(other - end) < height / 150; }));
}

TEST(CurveSkeleton, RefusesALengthThatIsNone) {
  const Curved box(make_box(4, 2, 1), 0.25, "sphere:80");
  for (const double reach : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(box.at(reach), CoreError);
}

// Its vertices keep their coordinates in the frame.
TEST(CurveSkeleton, GoesAlongWithAMapInTheFrameAffine) {
  const std::vector<Tube> tubes = {{turned({0, 0, 0}), turned({0, 0, 7}), 1},
                                   {turned({0, 0, 7}), turned({3, 0.5, 10}), 0.6},
                                   {turned({0, 0, 7}), turned({-2, 2.5, 9}), 0.5},
                                   {turned({0, 0, 7}), turned({-1.5, -3, 9.5}), 0.7}};
  const Mesh mesh = tube_mesh(tubes, 0.5);
  Mesh image = mesh;
  for (Vec3& p : image.points) p = {p.x + 0.7 * p.z, p.y + 0.4 * p.x, p.z};
  const double h = 0.3;
  const auto axes = [&](const Mesh& of) { return h * solid_frame(make_solid(of), FrameKind::kAffine); };
  const Curved one(mesh, axes(mesh), "triangles"), other(image, axes(image), "triangles");
  const CurveSkeleton before = one.at(), after = other.at();
  ASSERT_EQ(before.segments, after.segments);
  EXPECT_GE(before.ends, 3U);
  for (std::size_t v = 0; v < before.vertices.size(); ++v)
    EXPECT_LT(norm(before.vertices[v].position - after.vertices[v].position), 1e-6 * h);
}

}  // namespace
}  // namespace affskel::core

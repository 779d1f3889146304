// The ridge of bodies and of other solids with limbs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "core/base/unit.h"
#include "core/chords/chord_fields.h"
#include "core/mesh/box.h"
#include "core/mesh/edges.h"
#include "core/mesh/perturb.h"
#include "core/quality/similarity.h"
#include "core/ridge/local_depth.h"
#include "core/ridge/ridge_sheet.h"
#include "core/ridge/sheet_solids.h"
#include "core/shapes/body.h"
#include "core/shapes/edge_collapse.h"
#include "core/shapes/implicit_mesh.h"
#include "core/shapes/shapes.h"
#include "core/spatial/distance_to_mesh.h"
#include "core/spatial/point_index.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// The surface in the trunk, lines to the crown and the fingers, as near as 1.2 local radii and two spacings, and to the
// feet.
TEST(RidgeSheet, OfABodyReachesAllItsEnds) {
  const Mesh mesh = make_body({.triangles = 1000});
  const double h = box_of(mesh).longest_side() / 200;
  const ErodedSolid body(mesh, axes(h), "triangles");
  const RidgeSheet sheet = ridge_of(body);
  EXPECT_EQ(topology(sheet), (BettiNumbers{1, 0, 0}));
  EXPECT_FALSE(sheet.triangles.empty());
  EXPECT_GT(sheet.limbs, 0U);
  std::vector<Vec3> places;
  double lowest = box_of(mesh).high.z;
  for (const SheetVertex& v : sheet.vertices) {
    places.push_back(body.place(v.position));
    lowest = std::min(lowest, places.back().z);
    EXPECT_GT(v.erosion, 0);
    EXPECT_GT(v.area, 0);
    EXPECT_NEAR(norm(v.normal_a), 1, 1e-9);
  }
  const PointIndex index(places);
  const DistanceToMesh wall(mesh);
  EXPECT_LT(lowest - box_of(mesh).low.z, 0.03 * box_of(mesh).longest_side());
  for (const Vec3& to : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}}) {
    const Vec3 end = *std::max_element(mesh.points.begin(), mesh.points.end(),
                                       [&](const Vec3& a, const Vec3& b) { return dot(a, to) < dot(b, to); });
    EXPECT_LE(index.nearest(end), 1.2 * wall.nearest(places[index.find(end).number]) + 2 * h)
        << end.x << ' ' << end.z;
  }
}

// Noise as large as triangles bores tunnels and voids through all limbs, and pulls spikes out of them.
TEST(RidgeSheet, OfABodyUnderNoiseThatMakesItCrossItselfKeepsItsShape) {
  const Mesh mesh = make_body({.triangles = 5000});
  const double h = box_of(mesh).longest_side() / 110;
  const ErodedSolid body(mesh, axes(h), "sphere:400");
  const ErodedSolid noisy(perturb(mesh, {0.01 * box_diagonal(mesh), 1}), axes(h), "sphere:400");
  ASSERT_TRUE(noisy.solid.self_intersecting);
  const RidgeBasis basis = ridge_basis(noisy.solid, noisy.lattice, noisy.field);
  EXPECT_GT(basis.topology.holes, 20U);
  EXPECT_GT(basis.topology.cavities, 0U);
  const RidgeSheet sheet = ridge_sheet(noisy.solid, noisy.lattice, noisy.field, basis);
  BettiNumbers expected = sheet.lattice;
  expected.components -= sheet.fragments;
  EXPECT_EQ(topology(sheet), expected);
  EXPECT_LE(expected.holes, 2U);
  EXPECT_EQ(expected.cavities, 0U);
  std::vector<Vec3> clean_places, noisy_places;
  for (const SheetVertex& v : ridge_of(body).vertices) clean_places.push_back(body.place(v.position));
  for (const SheetVertex& v : sheet.vertices) noisy_places.push_back(noisy.place(v.position));
  const Similarity alike = similarity(clean_places, noisy_places);
  const double radius = box_diagonal(mesh) / 128;
  EXPECT_GT(alike.b_in_a.share_within(radius), 0.93);
  EXPECT_GT(alike.a_in_b.share_within(radius), 0.89);
}

// What is equally far is collapsed alike on both sides of the plane of symmetry, though the lattice's order runs towards
// it on one and away from it on the other.
TEST(RidgeSheet, OfAMirrorSymmetricBodyIsMirrorSymmetric) {
  for (const std::uint32_t triangles : {292U, 500U, 1000U}) {
    const Mesh mesh = make_body({.triangles = triangles});
    const double h = box_of(mesh).longest_side() / 150;
    const ErodedSolid body(mesh, axes(h), "triangles");
    RidgeSheet sheet = ridge_of(body);
    draw_out(sheet);
    std::vector<Vec3> places;
    for (const SheetVertex& v : sheet.vertices) places.push_back(body.place(v.position));
    const PointIndex index(places);
    double farthest = 0;
    for (const Vec3& place : places)
      farthest = std::max(farthest, index.nearest({-place.x, place.y, place.z}));
    EXPECT_LT(farthest, h) << triangles;
  }
}

// In arms and shins, which are nearly round, weak crossings stood on the strip: at 21 edges there were three squares.
TEST(RidgeSheet, OfABodyHasNoThornsInItsLimbs) {
  const Mesh mesh = make_body({.triangles = 500});
  const ErodedSolid body(mesh, axes(box_of(mesh).longest_side() / 150), "triangles");
  const RidgeSheet sheet = ridge_of(body);
  Edges(sheet.vertices.size(), sheet.triangles)
      .for_each(
          [](std::uint32_t, std::uint32_t, std::span<const EdgeSide> sides) { EXPECT_LE(sides.size(), 2U); });
}

// Where rims are evened out, what lay within stood out beyond them: in steps at heels, and a block on the neck.  Of every
// two triangles that lie over each other one is counted, where they are more than a sliver.
TEST(RidgeSheet, OfABodyIsNotFoldedAtItsRims) {
  const Mesh mesh = make_body({.triangles = 1000});
  const double h = box_of(mesh).longest_side() / 150;
  const ErodedSolid body(mesh, axes(h), "triangles");
  const RidgeSheet sheet = ridge_of(body);
  const auto at = [&](std::uint32_t v) { return sheet.vertices[v].position; };
  std::size_t edges = 0, folded = 0;
  Edges(sheet.vertices.size(), sheet.triangles)
      .for_each([&](std::uint32_t a, std::uint32_t b, std::span<const EdgeSide> sides) {
        if (sides.size() != 2) return;
        const Vec3 along = unit(at(b) - at(a));
        const auto off_edge = [&](const EdgeSide& side) {
          const Triangle& t = sheet.triangles[side.triangle()];
          const Vec3 way = at(t[0] ^ t[1] ^ t[2] ^ a ^ b) - at(a);
          return way - dot(way, along) * along;
        };
        const Vec3 one = off_edge(sides[0]), other = off_edge(sides[1]);
        ++edges;
        folded += std::min(norm(one), norm(other)) > 0.15 * h && dot(unit(one), unit(other)) > 0.5;
      });
  EXPECT_LT(folded, edges / 200) << edges;
}

// What lies nearer to the surface than 0.3 of the local depth is a corner cut at a bend, or a ridge in a hollow; a
// square that stands on a sheet at a corner is drawn together to nothing.
TEST(RidgeSheet, KeepsOffTheSurfaceAndHasNoTriangleWithoutArea) {
  const Mesh body = make_body({.triangles = 2000}), ring = make_torus(1.5, 1, 1024);
  for (const auto& [mesh, steps] : {std::pair{body, 150}, {ring, 40}}) {
    const double h = box_of(mesh).longest_side() / steps;
    const ErodedSolid solid(mesh, axes(h), "triangles");
    const RidgeSheet sheet = ridge_of(solid);
    const std::vector<float> depth = local_depth(solid.lattice, solid.field);
    const DistanceToMesh surface(mesh);
    std::size_t near = 0;
    for (const SheetVertex& v : sheet.vertices)
      near += surface.nearest(solid.place(v.position)) < 0.3 * h * static_cast<double>(depth[v.point]);
    EXPECT_LE(near, sheet.vertices.size() / 100);
    const auto at = [&](std::uint32_t v) { return sheet.vertices[v].position; };
    for (const auto& [a, b, c] : sheet.triangles)
      EXPECT_GT(0.5 * norm(cross(at(b) - at(a), at(c) - at(a))), 1e-5 * h * h);
  }
}

double to_block(const Vec3& p, const Vec3& centre, const Vec3& half) {
  const Vec3 q = p - centre;
  const double x = std::abs(q.x) - half.x, y = std::abs(q.y) - half.y, z = std::abs(q.z) - half.z;
  return norm(Vec3{std::max(x, 0.0), std::max(y, 0.0), std::max(z, 0.0)}) +
         std::min(0.0, std::max({x, y, z})) - 0.04;
}

// Ways lead from the seat round into the legs: drawn straight they had a corner of 34 degrees where the surface held them
// off.
TEST(RidgeSheet, OfAStoolHasNoCornersInItsWays) {
  const auto stool = [](const Vec3& p) {
    double least = to_block(p, {0, 0, 0}, {0.5, 0.5, 0.05});
    for (const double x : {-0.44, 0.44})
      for (const double y : {-0.44, 0.44})
        least = std::min(least, to_block(p, {x, y, -0.5}, {0.04, 0.04, 0.5}));
    return least;
  };
  const Mesh mesh =
      collapse_edges(moved(mesh_zero_set(stool, {{-1, -1, -1.2}, {1, 1, 0.4}, 0.04}), {2, 0, 0}), 2000);
  for (const double h : {1.0 / 34, 1.0 / 40}) {
    const ErodedSolid solid(mesh, axes(h), "sphere:1280");
    const RidgeSheet sheet = ridge_of(solid);
    std::vector<std::vector<std::uint32_t>> beside(sheet.vertices.size());
    for (const auto& [a, b] : sheet.segments) {
      beside[a].push_back(b);
      beside[b].push_back(a);
    }
    const auto at = [&](std::uint32_t v) { return sheet.vertices[v].position; };
    for (std::uint32_t v = 0; v < beside.size(); ++v) {
      if (beside[v].size() != 2 || sheet.vertices[v].kind != SkeletonKind::kWay) continue;
      const Vec3 before = unit(at(v) - at(beside[v][0])), after = unit(at(beside[v][1]) - at(v));
      EXPECT_GT(dot(before, after), 0.5 * std::numbers::sqrt3) << h << ' ' << v;  // 30 degrees
    }
  }
}

}  // namespace
}  // namespace affskel::core

// The planes' pieces against the join tree, which finds them in another way, and their derivatives against
// differences.
#include "core/infimum/chord_piece.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/execution_context.h"
#include "core/base/split_mix64.h"
#include "core/base/unit.h"
#include "core/erosion/directions.h"
#include "core/erosion/erosion.h"
#include "core/erosion/join_tree.h"
#include "core/erosion/tree_input.h"
#include "core/infimum/piece_input.h"
#include "core/infimum/saddle_search.h"
#include "core/infimum/samples.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

struct Case {
  std::string name;
  Mesh mesh;
};

// Under so much noise that hundreds of its triangles pass through each other.
Mesh crossing_body() {
  const Mesh body = make_body({.triangles = 500});
  return perturb(body, {.sigma = 0.015 * box_diagonal(body), .seed = 3});
}

std::vector<Case> cases() {
  return {{"ball", make_sphere(1, 500)},
          {"torus", shaken(make_torus(3, 1, 256), 0, 1)},
          {"cup", shaken(cup(24), 0, 2)},
          {"comb", shaken(comb(5), 0, 3)},
          {"hollow ball", hollow_ball()},
          {"two balls", joined(make_sphere(1, 80), moved(make_sphere(1, 200), {3, 0, 0}))},
          {"overlapping boxes", shaken(overlapping_boxes(4, 5, 6), 0, 4)},
          {"body", make_body({.triangles = 1000})},
          {"body that crosses itself", crossing_body()}};
}

void expect_as_the_trees(const Case& c) {
  SCOPED_TRACE(c.name);
  const Solid solid = make_solid(c.mesh);
  const Lattice lattice = lattice_of_points(solid, 400);
  const std::vector<Vec3> places = places_of(lattice);
  const PieceInput input(solid);
  PieceFinder finder(input);
  for (const Vec3& d : make_directions(solid, "random:60:7")) {
    const DirectionSet one{d};
    Erosion erosion(solid, lattice, one, {});
    ExecutionContext context;
    erosion.run(std::vector<std::uint32_t>{0}, context);
    for (std::uint32_t p = 0; p < lattice.points; ++p) {
      const FieldValue tree = erosion.field().value(p);
      const ChordPiece piece = finder.find(places[p], d);
      ASSERT_TRUE(piece.found);
      if (!solid.crossings.empty() && !(piece.volume > 0)) continue;  // turned inside out
      ASSERT_NEAR(piece.volume, tree.erosion, 1e-10 * input.volume + 1e-10 * tree.erosion) << p;
      ASSERT_NEAR(piece.area, tree.area, 1e-7) << p;
    }
  }
}

TEST(ChordPieceTest, VolumesAndAreasAreTheJoinTrees) {
  for (const Case& c : cases()) expect_as_the_trees(c);
}

TEST(ChordPieceTest, DerivativesAreThoseOfTheVolume) {
  const Solid solid = make_solid(make_body({.triangles = 1000}));
  const PieceInput input(solid);
  PieceFinder finder(input);
  const std::vector<Vec3> places = places_of(lattice_of_points(solid, 100));
  constexpr double kStep = 1e-5;
  int compared = 0;
  for (const std::size_t p : {5U, 40U, 80U}) {
    const Vec3& x = places[p];
    for (const Vec3& d : make_directions(solid, "random:40:3")) {
      const ChordPiece at = finder.find(x, d);
      const Hessian hessian = finder.hessian();
      const auto tilted = [&](double s, double t) { return finder.find(x, unit(d + (s * at.u + t * at.w))); };
      const ChordPiece right = tilted(kStep, 0), left = tilted(-kStep, 0), up = tilted(0, kStep),
                       down = tilted(0, -kStep);
      // Beside a saddle the volume jumps.
      if (std::abs(right.volume - left.volume) + std::abs(up.volume - down.volume) > 1e-4) continue;
      ++compared;
      EXPECT_NEAR((right.volume - left.volume) / (2 * kStep), at.gradient[0], 1e-6);
      EXPECT_NEAR((up.volume - down.volume) / (2 * kStep), at.gradient[1], 1e-6);
      EXPECT_NEAR((right.volume - 2 * at.volume + left.volume) / (kStep * kStep), hessian[0], 2e-3);
      EXPECT_NEAR((up.volume - 2 * at.volume + down.volume) / (kStep * kStep), hessian[2], 2e-3);
      const double mixed = tilted(kStep, kStep).volume - tilted(kStep, -kStep).volume -
                           tilted(-kStep, kStep).volume + tilted(-kStep, -kStep).volume;
      EXPECT_NEAR(mixed / (4 * kStep * kStep), hessian[1], 2e-3);
    }
  }
  EXPECT_GT(compared, 100);
}

// The volume of the component that holds a triangle's lowest vertex, below h.
double volume_with(const JoinTree& tree, std::uint32_t triangle, double h) {
  const Arc& arc = tree.arcs[tree.climb(triangle, h)];
  return tree.locate(arc, h).volume_at(h);
}

void expect_what_trees_hold(const Case& c, std::array<std::size_t, 2>& count) {
  SCOPED_TRACE(c.name);
  const Solid solid = make_solid(c.mesh);
  const PieceInput input(solid);
  PieceFinder finder(input);
  const TreeInput trees(solid);
  JoinTreeBuilder builder(trees, {.crosses_itself = !solid.crossings.empty()});
  std::map<std::array<double, 3>, std::uint32_t> number;
  for (std::uint32_t v = 0; v < input.mesh.points.size(); ++v) {
    const Vec3& p = input.mesh.points[v];
    number[{p.x, p.y, p.z}] = v;
  }
  for (const Vec3& d : make_directions(solid, "random:12:5")) {
    const JoinTree& tree = builder.build(d);
    for (const Vec3& x : places_of(lattice_of_points(solid, 40))) {
      const double h = dot(d, x), volume = finder.find(x, d).volume;
      for (std::uint32_t t = 0; t < solid.mesh.triangles.size(); ++t) {
        Vec3 lowest = solid.mesh.points[solid.mesh.triangles[t][0]];
        for (const std::uint32_t v : solid.mesh.triangles[t]) {
          if (dot(d, solid.mesh.points[v]) < dot(d, lowest)) lowest = solid.mesh.points[v];
        }
        if (dot(d, lowest) >= h - 1e-9) continue;
        const bool expected = std::abs(volume_with(tree, t, h) - volume) <= 1e-9 * input.volume;
        ASSERT_EQ(finder.holds(number.at({lowest.x, lowest.y, lowest.z})), expected);
        ++count[expected ? 1 : 0];
      }
    }
  }
}

TEST(ChordPieceTest, HoldsWhatTheTreeHas) {
  std::array<std::size_t, 2> count{};  // of vertices below that are not of the piece, and of those that are
  for (const Case& c : cases()) expect_what_trees_hold(c, count);
  EXPECT_GT(count[0], 1000U);
  EXPECT_GT(count[1], 1000U);
}

struct JoinCount {
  std::size_t joins = 0, known = 0;
  std::size_t tiny = 0;  // joins of parts of next to no volume
};

JoinCount expect_joins_where_the_volume_jumps(const Mesh& mesh) {
  const Solid solid = make_solid(mesh);
  const PieceInput input(solid);
  PieceFinder finder(input);
  SaddleSearch search(input);
  SplitMix64 random(7);
  JoinCount count;
  for (const Vec3& x : places_of(lattice_of_points(solid, 40))) {
    for (const PieceInput::Saddle& saddle : input.saddles) {
      const Vec3 s = input.mesh.points[saddle.vertex] - x, d = draw_direction(random);
      const Vec3 touching = unit(d - (dot(d, s) / dot(s, s)) * s);
      const ChordPiece piece = finder.find(x, touching);
      if (!piece.found) continue;
      const auto other = static_cast<std::uint32_t>(draw_share(random) * double(input.mesh.points.size()));
      const bool held = finder.holds(other);
      const PieceFinder::Joins at = finder.joins_at(saddle.vertex);
      EXPECT_EQ(finder.holds(other), held);
      const double beyond = finder.find(x, unit(touching - (1e-9 / dot(s, s)) * s)).volume;
      const bool jumps = std::abs(beyond - piece.volume) > 1e-6 * std::abs(piece.volume) + 1e-9;
      EXPECT_LE(jumps, search.may_join(x, saddle, touching));
      if (at == PieceFinder::Joins::unknown) continue;
      EXPECT_LE(jumps, at == PieceFinder::Joins::yes);
      count.joins += at == PieceFinder::Joins::yes;
      count.tiny += at == PieceFinder::Joins::yes && !jumps;
      ++count.known;
    }
  }
  return count;
}

TEST(ChordPieceTest, PartsJoinWhereTheVolumeJumps) {
  const JoinCount count = expect_joins_where_the_volume_jumps(make_body({.triangles = 500}));
  EXPECT_GT(count.joins, 50U);
  EXPECT_EQ(count.tiny, 0U);
  EXPECT_GT(count.known, 5000U);
}

TEST(ChordPieceTest, PartsJoinWhereTrianglesPassThroughEachOther) {
  const JoinCount count = expect_joins_where_the_volume_jumps(crossing_body());
  EXPECT_GT(count.joins, 100U);
  EXPECT_LT(count.tiny, 20U);
  EXPECT_GT(count.known, 5000U);
}

}  // namespace
}  // namespace affskel::core

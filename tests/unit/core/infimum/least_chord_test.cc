// Least pieces against closed forms, against planes near them, and their slopes against differences.
#include "core/infimum/least_chord.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/affine_map.h"
#include "core/base/split_mix64.h"
#include "core/base/unit.h"
#include "core/infimum/chord_piece.h"
#include "core/infimum/piece_input.h"
#include "core/infimum/samples.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

LeastChord start_at(const Vec3& normal) {
  LeastChord start;
  start.normal = normal;
  return start;
}

// The least of descents from several directions.
LeastChord least_of_many(ChordDescent& descent, const Vec3& x, std::uint64_t seed, int starts) {
  SplitMix64 random(seed);
  LeastChord best;
  for (int n = 0; n < starts; ++n) {
    const LeastChord least = descent.descend(x, start_at(draw_direction(random)));
    if (least.erosion < best.erosion) best = least;
  }
  return descent.look_across(x, best);
}

TEST(LeastChordTest, CornersOfABox) {
  const Solid solid = make_solid(make_box(2, 1, 0.75));
  const PieceInput input(solid);
  ChordDescent descent(input);
  const double unit_length = solid.scale();
  SplitMix64 random(1);
  for (int n = 0; n < 50; ++n) {
    // The least tetrahedron with a given point on its fourth side cuts three times its distances off the edges.
    const double a = 0.6 * draw_share(random), b = 0.3 * draw_share(random), c = 0.24 * draw_share(random);
    const Vec3 x = (1 / unit_length) * (solid.bbox_min + Vec3{a, b, c} - solid.centre);
    const LeastChord least = least_of_many(descent, x, 10 + static_cast<std::uint64_t>(n), 12);
    const double expected = 4.5 * a * b * c / std::pow(unit_length, 3);
    EXPECT_NEAR(least.erosion, expected, 1e-9 * expected) << a << " " << b << " " << c;
    EXPECT_EQ(least.kind(), 0);
    EXPECT_NEAR(least.slope, least.area, 1e-12);
    const Vec3 normal = unit({1 / a, 1 / b, 1 / c});
    EXPECT_GT(dot(least.normal, normal), 1 - 1e-9);
  }
}

// E(M x) of M V is det M times E(x) of V.
TEST(LeastChordTest, FollowsAffineMaps) {
  const Mesh body = make_body({.triangles = 500});
  const AffineMap map{{{{1, 0.4, -0.2}, {0.1, 0.7, 0.3}, {-0.3, 0.2, 1.3}}}, {5, -2, 1}};
  Mesh mapped = body;
  for (Vec3& p : mapped.points) p = map(p);
  const Solid solid = make_solid(body), solid_of_map = make_solid(mapped);
  const PieceInput input(solid), input_of_map(solid_of_map);
  ChordDescent descent(input), descent_of_map(input_of_map);
  const double ratio = solid_of_map.volume / solid.volume;
  for (const Vec3& x : places_of(lattice_of_points(solid, 60))) {
    const Vec3 there = map(solid.centre + solid.scale() * x);
    const LeastChord least = least_of_many(descent, x, 3, 3);
    // Normals go with the inverse transpose: columns of adj(M).
    const Vec3 &a = map.rows[0], &b = map.rows[1], &c = map.rows[2], &n = least.normal;
    const Vec3 turned = unit({dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n)});
    const Vec3 mapped_x = (1 / solid_of_map.scale()) * (there - solid_of_map.centre);
    const LeastChord other =
        descent_of_map.look_across(mapped_x, descent_of_map.descend(mapped_x, start_at(turned)));
    const double here = least.erosion * std::pow(solid.scale(), 3) * ratio;
    EXPECT_NEAR(other.erosion * std::pow(solid_of_map.scale(), 3), here, 2e-6 * here);
  }
}

class BodyTest : public testing::Test {
 protected:
  static const Mesh& body() {
    static const Mesh mesh = make_body({.triangles = 1000});  // takes a second
    return mesh;
  }

  BodyTest() : solid_(make_solid(body())), input_(solid_), descent_(input_) {
    points_ = places_of(lattice_of_points(solid_, 300));
  }

  Solid solid_;
  PieceInput input_;
  ChordDescent descent_;
  std::vector<Vec3> points_;
};

TEST_F(BodyTest, NoPlaneNearItHasALesserPiece) {
  PieceFinder finder(input_);
  SplitMix64 random(5);
  int kinds[3] = {0, 0, 0};
  for (const Vec3& x : points_) {
    const LeastChord least = descent_.look_across(x, descent_.descend(x, start_at(draw_direction(random))));
    ASSERT_LT(least.erosion, input_.volume);
    ++kinds[least.kind()];
    for (int n = 0; n < 40; ++n) {
      const double tilt = n % 2 == 0 ? 1e-3 : 1e-5;
      const ChordPiece other = finder.find(x, unit(least.normal + tilt * draw_direction(random)));
      ASSERT_GE(other.volume, least.erosion * (1 - 1e-9)) << least.kind();
    }
  }
  // Every kind is met.
  for (const int kind : kinds) EXPECT_GT(kind, 20);
}

TEST_F(BodyTest, SaddlesLieInThePlane) {
  SplitMix64 random(6);
  for (const Vec3& x : points_) {
    const LeastChord least = descent_.descend(x, start_at(draw_direction(random)));
    for (const std::uint32_t s : least.saddles) {
      if (s == kNone) continue;
      EXPECT_NEAR(dot(least.normal, input_.mesh.points[s] - x), 0, 1e-13);
    }
    EXPECT_GE(least.slope, least.area * (1 - 1e-12));
    if (least.kind() == 0) {
      EXPECT_DOUBLE_EQ(least.slope, least.area);
    }
  }
}

// grad E = slope normal: E at places beside x, each least again, against it.
TEST_F(BodyTest, TheSlopeIsTheGradient) {
  SplitMix64 random(8);
  constexpr double kStep = 1e-5;
  int compared[3] = {0, 0, 0};
  for (const Vec3& x : points_) {
    const LeastChord least = descent_.descend(x, start_at(draw_direction(random)));
    const Vec3 aside = draw_direction(random);
    const LeastChord ahead = descent_.descend(x + kStep * aside, least);
    const LeastChord behind = descent_.descend(x - kStep * aside, least);
    // Where others become active, or a piece across a saddle is less, E bends.
    if (ahead.saddles != least.saddles || behind.saddles != least.saddles) continue;
    if (dot(ahead.normal, behind.normal) < 1 - 1e-5) continue;
    const double expected = least.slope * dot(least.normal, aside);
    EXPECT_NEAR((ahead.erosion - behind.erosion) / (2 * kStep), expected, 1e-3 * least.slope) << least.kind();
    ++compared[least.kind()];
  }
  for (const int count : compared) EXPECT_GT(count, 20);
}

TEST_F(BodyTest, GivesUpAboveABound) {
  const Vec3& x = points_[100];
  const LeastChord start = start_at({0.6, 0, 0.8});
  const LeastChord least = descent_.descend(x, start);
  const std::uint64_t before = descent_.evaluations();
  EXPECT_FALSE(std::isfinite(descent_.descend(x, start, {.erosion = 0.999 * least.erosion}).erosion));
  EXPECT_FALSE(std::isfinite(descent_.descend(x, start, {.first = 0.5 * least.erosion}).erosion));
  EXPECT_LT(descent_.evaluations() - before, 60U);
  EXPECT_EQ(descent_.descend(x, start, {.erosion = 100 * least.erosion}).erosion, least.erosion);
}

TEST_F(BodyTest, OutsideThereIsNone) {
  EXPECT_FALSE(std::isfinite(descent_.descend({0.49, 0.49, 0.49}, start_at({0, 0, 1})).erosion));
}

}  // namespace
}  // namespace affskel::core

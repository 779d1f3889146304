// The refined field against closed forms, large sets of directions and its own invariants.
#include "core/infimum/refine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/base/affine_map.h"
#include "core/base/basis.h"
#include "core/base/error.h"
#include "core/base/execution_context.h"
#include "core/base/unit.h"
#include "core/erosion/computed.h"
#include "core/erosion/directions.h"
#include "core/erosion/join_tree.h"
#include "core/erosion/place_chords.h"
#include "core/infimum/refinement.h"
#include "core/infimum/samples.h"
#include "core/lattice/lattice.h"
#include "core/mesh/box.h"
#include "core/mesh/perturb.h"
#include "core/shapes/body.h"
#include "core/shapes/shapes.h"
#include "core/stopping_context.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

struct Refined {
  Refined(const Mesh& mesh, std::uint64_t points, const std::string& directions, unsigned threads = 1)
      : Refined(
            make_solid(mesh), [&](const Solid& s) { return lattice_of_points(s, points); }, directions,
            threads) {}

  template <class MakeLattice>
  Refined(Solid of, const MakeLattice& lattice_of, const std::string& directions, unsigned threads = 1)
      : solid(std::move(of)),
        lattice(lattice_of(solid)),
        seeds(compute(solid, lattice, directions)),
        volume_unit(std::pow(solid.scale(), 3)) {
    ErosionField field(lattice.points, false);
    for (std::uint32_t p = 0; p < lattice.points; ++p) field.offer(p, scaled_seed(p));
    ExecutionContext context;
    values = refine(PieceInput(solid), lattice, seeds.directions, field, threads, context);
  }

  FieldValue scaled_seed(std::uint32_t p) const {
    FieldValue value = seeds.value[p];
    value.erosion /= volume_unit;  // a power of two
    value.area /= solid.scale() * solid.scale();
    return value;
  }

  /// E at a point, in mesh units.
  double erosion(std::uint32_t p) const { return values[p].erosion * volume_unit; }

  Solid solid;
  Lattice lattice;
  Computed seeds;
  double volume_unit;
  std::vector<LeastChord> values;
};

TEST(RefineTest, ABoxHasItsClosedForm) {
  const Refined refined(make_box(3, 2, 2), 2000, "sphere:100");
  std::size_t corners = 0;
  for (std::uint32_t p = 0; p < refined.lattice.points; ++p) {
    const Vec3& x = refined.seeds.place[p];
    const Vec3 low = x - refined.solid.bbox_min, high = refined.solid.bbox_max - x;
    const double a = std::min(low.x, high.x), b = std::min(low.y, high.y), c = std::min(low.z, high.z);
    const double e = refined.erosion(p);
    // A slab, and a wedge along an edge, are planes too.
    EXPECT_LE(e, std::min({a * 4, b * 6, c * 6, 2 * a * b * 2, 2 * a * c * 2, 2 * b * c * 3}) * (1 + 1e-9));
    if (a > 1 || 3 * b > 2 || 3 * c > 2) continue;
    EXPECT_NEAR(e, 4.5 * a * b * c, 1e-8 * a * b * c);
    ++corners;
  }
  EXPECT_GT(corners, 500U);
}

TEST(RefineTest, NeverAboveItsSeedsNorManyMore) {
  const std::vector<std::pair<std::string, Mesh>> cases = {
      {"torus", shaken(make_torus(3, 1, 256), 0, 1)},
      {"cup", shaken(cup(24), 0, 2)},
      {"hollow ball", hollow_ball()},
      {"overlapping boxes", shaken(overlapping_boxes(4, 5, 6), 0, 4)},
      {"body", make_body({.triangles = 1000})},
      {"coarse body", make_body({.triangles = 500})},
      {"coarsest body", make_body({.triangles = 292})}};
  for (const auto& [name, mesh] : cases) {
    SCOPED_TRACE(name);
    const Refined refined(mesh, 3000, "triangles+sphere:1000");
    const Computed many = compute(refined.solid, refined.lattice, "sphere:20000");
    for (std::uint32_t p = 0; p < refined.lattice.points; ++p) {
      EXPECT_LE(refined.erosion(p), refined.seeds.value[p].erosion * (1 + 1e-9));
      EXPECT_LE(refined.erosion(p), many.value[p].erosion * (1 + 1e-6));
      EXPECT_NEAR(norm(refined.values[p].normal), 1, 1e-12);
    }
  }
}

TEST(RefineTest, TheSameOnSeveralThreads) {
  const Mesh mesh = make_body({.triangles = 500});
  const Refined one(mesh, 3000, "triangles"), three(mesh, 3000, "triangles", 3);
  for (std::uint32_t p = 0; p < one.lattice.points; ++p) {
    const LeastChord &a = one.values[p], &b = three.values[p];
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.erosion), std::bit_cast<std::uint64_t>(b.erosion));
    EXPECT_EQ(std::bit_cast<std::uint64_t>(a.slope), std::bit_cast<std::uint64_t>(b.slope));
    EXPECT_TRUE(a.normal == b.normal);
    EXPECT_EQ(a.saddles, b.saddles);
  }
}

// The rounds by ranges of points, in another order, as workers compute them.
TEST(RefineTest, TheSameByRanges) {
  const Refined whole(make_body({.triangles = 500}), 3000, "triangles");
  const PieceInput input(whole.solid);
  Refinement parts(input, whole.lattice, 1);
  ExecutionContext context;
  const auto seed = [&](std::uint32_t p) { return whole.scaled_seed(p); };
  std::vector<RefinedPoint> found;
  int round = 0;
  do {
    found.clear();
    for (std::uint32_t end = whole.lattice.points; end > 0;) {
      const PointRange range{end > 700 ? end - 700 : 0, end};
      const std::vector<RefinedPoint> part = round == 0
                                                 ? parts.descend(whole.seeds.directions, seed, range, context)
                                                 : parts.improve(round, range, context);
      found.insert(found.end(), part.begin(), part.end());
      end = range.begin;
    }
    for (const RefinedPoint& point : found) parts.set(point, round);
    ++round;
  } while (!found.empty());
  EXPECT_GT(round, 3);
  for (std::uint32_t p = 0; p < whole.lattice.points; ++p) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(parts.least()[p].erosion),
              std::bit_cast<std::uint64_t>(whole.values[p].erosion));
    EXPECT_TRUE(parts.least()[p].normal == whole.values[p].normal);
  }
}

// One point in eight in round 0, those with one, two, three odd indices each in their round.
TEST(RefineTest, PointsBeginInFourRounds) {
  const Refined whole(make_body({.triangles = 500}), 3000, "triangles");
  const PieceInput input(whole.solid);
  Refinement rounds(input, whole.lattice, 1);
  ExecutionContext context;
  std::vector<std::uint32_t> all(whole.lattice.points);
  std::iota(all.begin(), all.end(), 0U);
  const std::vector<LatticePlace> places = lattice_places(whole.lattice, all);
  const auto seed = [&](std::uint32_t p) { return whole.scaled_seed(p); };
  for (int round = 0; round < 4; ++round) {
    const PointRange range{0, whole.lattice.points};
    const std::vector<RefinedPoint> found = round == 0
                                                ? rounds.descend(whole.seeds.directions, seed, range, context)
                                                : rounds.improve(round, range, context);
    std::size_t begun = 0, of_round = 0;
    for (const RefinedPoint& point : found) {
      const auto& [i, j, k] = places[point.point];
      const bool waits = point.least.erosion == seed(point.point).erosion;
      begun += !waits && static_cast<int>(i % 2 + j % 2 + k % 2) == round;
      rounds.set(point, round);
    }
    for (const auto& [i, j, k] : places) of_round += static_cast<int>(i % 2 + j % 2 + k % 2) == round;
    EXPECT_GT(static_cast<double>(begun), 0.8 * static_cast<double>(of_round)) << round;
    if (round == 0) {
      const auto waiting = std::count_if(found.begin(), found.end(), [&](const RefinedPoint& point) {
        return point.least.erosion == seed(point.point).erosion;
      });
      EXPECT_GT(static_cast<double>(waiting), 0.7 * whole.lattice.points);
    }
  }
}

// Subdivision adds normals to no set and vertices to no edge of the solid.
TEST(RefineTest, SubdividingChangesNothing) {
  const Mesh mesh = make_body({.triangles = 292});
  Mesh finer;
  finer.points = mesh.points;
  for (const Triangle& t : mesh.triangles) {
    const auto middle = static_cast<std::uint32_t>(finer.points.size());
    finer.points.push_back((1.0 / 3) * (mesh.points[t[0]] + mesh.points[t[1]] + mesh.points[t[2]]));
    for (std::size_t k = 0; k < 3; ++k) finer.triangles.push_back({t[k], t[(k + 1) % 3], middle});
  }
  const Refined coarse(mesh, 2000, "sphere:2000"), fine(finer, 2000, "sphere:2000");
  ASSERT_EQ(coarse.lattice.points, fine.lattice.points);
  std::size_t differ = 0;
  for (std::uint32_t p = 0; p < coarse.lattice.points; ++p) {
    const double a = coarse.values[p].erosion, b = fine.values[p].erosion;
    differ += std::abs(a - b) > 1e-6 * std::min(a, b);
  }
  EXPECT_LE(differ, coarse.lattice.points / 100);
}

// The closed form of a corner is affine: 27 times the product of the barycentric coordinates.
TEST(RefineTest, ATetrahedronHasItsClosedForm) {
  const Refined refined(make_tetrahedron(2), 3000, "sphere:100");
  const std::vector<Vec3>& corner = refined.solid.mesh.points;
  const auto volume = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return std::abs(dot(a, cross(b, c)));
  };
  const double whole = volume(corner[1] - corner[0], corner[2] - corner[0], corner[3] - corner[0]);
  const std::vector<Vec3> places = places_of(refined.lattice);
  std::size_t corners = 0;
  for (std::uint32_t p = 0; p < refined.lattice.points; ++p) {
    std::array<double, 4> share;
    for (std::size_t k = 0; k < 4; ++k) {
      share[k] = volume(corner[(k + 1) % 4] - places[p], corner[(k + 2) % 4] - places[p],
                        corner[(k + 3) % 4] - places[p]) /
                 whole;
    }
    std::sort(share.begin(), share.end());
    const double expected = 27 * share[0] * share[1] * share[2] * refined.solid.volume;
    EXPECT_LE(refined.erosion(p), expected * (1 + 1e-8) + (share[2] > 1.0 / 3 ? refined.solid.volume : 0));
    if (share[2] > 0.2) continue;
    EXPECT_NEAR(refined.erosion(p), expected, 1e-8 * expected);
    ++corners;
  }
  EXPECT_GT(corners, 200U);
}

// Whatever a convex solid is begun from, its field is one.
TEST(RefineTest, ConvexSolidsDoNotDependOnTheSeeds) {
  for (const Mesh& mesh : {make_sphere(1, 320), make_ellipsoid(1, 2, 0.5, 320), make_cylinder(1, 3, 24),
                           make_cone(1, 3, 24), make_box(3, 2, 1.5, 3)}) {
    const Refined few(mesh, 1500, "sphere:300"), many(mesh, 1500, "triangles+sphere:5000");
    std::size_t differ = 0;
    for (std::uint32_t p = 0; p < few.lattice.points; ++p) {
      EXPECT_EQ(few.values[p].kind(), 0);
      differ += std::abs(few.erosion(p) / many.erosion(p) - 1) > 1e-6;
    }
    EXPECT_LE(differ, few.lattice.points / 1000) << mesh.triangles.size();
  }
}

double chord_by_trees(const PlaceChords& chords, std::size_t place, JoinTreeBuilder& builder, const Vec3& d) {
  float volume = 0;
  chords.along(builder.build(d), d, place, 0, {&volume, 1});
  return double(volume);
}

// The least chord at a place by join trees alone, from a direction on: steps along two axes, shorter and shorter.
double least_by_trees(const PlaceChords& chords, std::size_t place, JoinTreeBuilder& builder, Vec3 d) {
  const auto chord = [&](const Vec3& direction) { return chord_by_trees(chords, place, builder, direction); };
  double least = chord(d);
  for (double step = 0.02; step > 1e-7;) {
    Vec3 u, w;
    make_basis(d, u, w);
    bool lower = false;
    for (const Vec3& tilt : {u, -1 * u, w, -1 * w}) {
      const Vec3 tilted = unit(d + step * tilt);
      const double volume = chord(tilted);
      if (volume >= least) continue;
      least = volume;
      d = tilted;
      lower = true;
      break;
    }
    if (!lower) step *= 0.5;
  }
  return least;
}

TEST(RefineTest, ConvexSolidsHaveTheLeastThatTreesFind) {
  std::size_t above = 0, points = 0;
  for (const Mesh& mesh : {make_sphere(1, 320), make_ellipsoid(1, 2, 0.5, 320), make_cylinder(1, 3, 3),
                           make_cylinder(1, 3, 24), make_cone(1, 3, 24), make_box(3, 2, 1.5)}) {
    const Refined refined(mesh, 1500, "sphere:300");
    const Computed many = compute(refined.solid, refined.lattice, "sphere:20000");
    const std::vector<Vec3> places = places_of(refined.lattice);
    const PlaceChords chords(refined.solid, places);
    const TreeInput input(refined.solid);
    JoinTreeBuilder builder(input);
    for (std::uint32_t p = 0; p < refined.lattice.points; p += 31) {
      const double least =
          least_by_trees(chords, p, builder, many.directions[many.value[p].direction]) * refined.volume_unit;
      above += refined.erosion(p) > least * (1 + 1e-6);
      ++points;
      const double there = chord_by_trees(chords, p, builder, refined.values[p].normal);
      EXPECT_NEAR(refined.values[p].erosion, there, 1e-6 * there);  // chords have 24 bits
    }
  }
  EXPECT_GT(points, 250U);
  EXPECT_EQ(above, 0U);
}

// E(M x) of M V is det M times E(x) of V: on the mapped lattice, from the mapped normals.
TEST(RefineTest, FollowsAffineMaps) {
  const AffineMap map{{{{1, 0.4, -0.2}, {0.1, 0.7, 0.3}, {-0.3, 0.2, 1.3}}}, {5, -2, 1}};
  for (const Mesh& mesh : {shaken(make_torus(3, 1, 256), 0, 1), make_body({.triangles = 500})}) {
    Mesh mapped = mesh;
    for (Vec3& p : mapped.points) p = map(p);
    const Refined here(mesh, 2000, "triangles");
    const auto mapped_lattice = [&](const Solid& solid) {
      LatticeGrid grid = here.lattice.grid;
      const double from = here.solid.scale(), to = 1 / solid.scale();
      grid.origin = to * (map(here.solid.centre + from * grid.origin) - solid.centre);
      const Vec3 zero = map(Vec3{});
      for (Vec3& axis : grid.axes) axis = to * (map(from * axis) - zero);
      return make_lattice(solid, grid);
    };
    const Refined there(make_solid(mapped), mapped_lattice, "triangles");
    ASSERT_EQ(here.lattice.points, there.lattice.points);
    const double ratio = there.solid.volume / here.solid.volume;
    std::size_t differ = 0;
    for (std::uint32_t p = 0; p < here.lattice.points; ++p) {
      differ += std::abs(there.erosion(p) / (ratio * here.erosion(p)) - 1) > 1e-6;
    }
    EXPECT_EQ(differ, 0U) << mesh.triangles.size();
  }
}

// Noise that makes a body cross itself turns sections inside out.
TEST(RefineTest, NoSlopeIsNegativeWhereASolidOverlapsItself) {
  const Mesh body = make_body({500, 1800});
  const Refined refined(perturb(body, {.sigma = 0.015 * box_diagonal(body), .seed = 3}), 2000, "sphere:100");
  for (std::uint32_t p = 0; p < refined.lattice.points; ++p) {
    EXPECT_GE(refined.values[p].slope, 0) << p;
    EXPECT_LE(refined.erosion(p), refined.seeds.value[p].erosion * (1 + 1e-9)) << p;
  }
}

TEST(RefineTest, StopsWhenAsked) {
  const Solid solid = make_solid(make_box(1, 1, 1));
  const Lattice lattice = lattice_of_points(solid, 100);
  const DirectionSet set = make_directions(solid, "triangles");
  ErosionField seeds(lattice.points, false);
  StoppingContext context(0);
  EXPECT_THROW(refine(PieceInput(solid), lattice, set, seeds, 1, context), CoreError);
}

}  // namespace
}  // namespace affskel::core

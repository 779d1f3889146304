#include "core/surface/eroded_solid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include "core/base/error.h"
#include "core/erosion/erosion.h"
#include "core/lattice/scan_conversion.h"
#include "core/mesh_checks.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

constexpr double kPi = 3.14159265358979323846;

struct Eroded {
  Solid solid;
  Lattice lattice;
  FrameField field;

  ErodedSurface surface(double level) const {
    return eroded_surface(solid, lattice, field, {.level = level});
  }
  double most() const { return *std::max_element(field.erosion.begin(), field.erosion.end()); }
};

// The field of the library's own erosion.
Eroded computed(const Mesh& mesh, const std::function<Lattice(const Solid&)>& make,
                const std::string& spec = "triangles") {
  Eroded result{make_solid(mesh), {}, {}};
  result.lattice = make(result.solid);
  const DirectionSet directions = make_directions(result.solid, spec);
  Erosion erosion(result.solid, result.lattice, directions, {});
  std::vector<std::uint32_t> list(directions.size());
  std::iota(list.begin(), list.end(), 0U);
  ExecutionContext context;
  erosion.run(list, context);
  const double unit = result.solid.scale();
  std::vector<FieldValue> values;
  for (std::uint32_t p = 0; p < result.lattice.points; ++p) {
    FieldValue value = erosion.field().value(p);
    value.erosion *= unit * unit * unit;
    value.area *= unit * unit;
    values.push_back(value);
  }
  result.field = frame_field(result.lattice, directions, values);
  return result;
}

std::function<Lattice(const Solid&)> spaced(double spacing) {
  return [spacing](const Solid& solid) {
    LatticeOptions options;
    options.spacing = spacing;
    return make_lattice(solid, options);
  };
}

void for_each_point(const Eroded& e, const std::function<void(std::uint32_t, const Vec3&)>& visit) {
  const SamplePlaces places(e.solid, e.lattice);
  for (const LatticeRun& run : e.lattice.axis[2].runs) {
    for (std::uint32_t n = 0; n < run.length; ++n) {
      visit(run.first + n, places.at(run.start[0], run.start[1], run.start[2] + n));
    }
  }
}

// A field given by its formula, on an axis-parallel lattice.
Eroded given(const Mesh& mesh, double spacing, const std::function<double(const Vec3&)>& erosion,
             const std::function<Vec3(const Vec3&)>& gradient) {
  SolidOptions options;
  options.check_self_intersections = false;
  Eroded result{make_solid(mesh, options), {}, {}};
  result.lattice = spaced(spacing)(result.solid);
  result.field.spacing = spacing;
  for_each_point(result, [&](std::uint32_t, const Vec3& x) {
    result.field.erosion.push_back(erosion(x));
    result.field.gradient.push_back(gradient(x));
    result.field.direction.push_back(0);
  });
  return result;
}

// E = 1 everywhere: the eroded solid is the solid itself.
Eroded uneroded(const Mesh& mesh, double spacing) {
  return given(
      mesh, spacing, [](const Vec3&) { return 1.0; }, [](const Vec3&) { return Vec3{}; });
}

// The unit ball's closed form: E = pi (1 - p)^2 (2 + p) / 3 at the distance p from the centre.
double ball_level(double p) {
  return kPi * (1 - p) * (1 - p) * (2 + p) / 3;
}
Eroded ball(double spacing) {
  return given(
      make_sphere(1, 20000), spacing, [](const Vec3& x) { return ball_level(std::min(1.0, norm(x))); },
      [](const Vec3& x) {
        const double p = norm(x);
        return p > 0 ? (-kPi * (1 - p * p) / p) * x : Vec3{};
      });
}

void expect_manifold(const Mesh& mesh) {
  const MeshFacts facts = mesh_facts(mesh);
  EXPECT_TRUE(facts.closed);
  EXPECT_TRUE(facts.oriented);
  EXPECT_TRUE(facts.vertices_manifold);
  EXPECT_EQ(facts.unused_vertices, 0u);
}

// Counts, by crossings along z, whether each sample point lies inside the mesh as its E says; those whose E
// differs from the level by less than `slack` times what the gradient makes of a spacing may err.
void expect_sides(const Eroded& e, const Mesh& mesh, double level, double slack) {
  const SamplePlaces places(e.solid, e.lattice);
  LatticeGrid grid = e.lattice.grid;
  grid.origin = places.origin();
  grid.axes = places.axes();
  const LineCrossings lines = scan_convert(mesh, grid, 2);
  std::size_t wrong = 0;
  for (const LatticeRun& run : e.lattice.axis[2].runs) {
    const std::size_t line = std::size_t{run.start[0]} * grid.dims[1] + run.start[1];
    for (std::uint32_t n = 0; n < run.length; ++n) {
      int winding = 0;
      for (std::uint64_t c = lines.begin[line]; c < lines.begin[line + 1]; ++c) {
        if (lines.crossings[c].depth <= run.start[2] + n) winding -= lines.crossings[c].exits;
      }
      const std::uint32_t p = run.first + n;
      const double reach = slack * e.field.spacing * norm(e.field.gradient[p]);
      wrong += (winding > 0) != (e.field.erosion[p] >= level) && std::abs(e.field.erosion[p] - level) > reach;
      EXPECT_TRUE(winding == 0 || winding == 1);
    }
  }
  EXPECT_EQ(wrong, 0u);
}

TEST(ErodedPointsTest, AreThoseAtTheLevelOrAbove) {
  const FrameField field{1, {3, 1, 2, 5, 2}, {}, {}};
  EXPECT_EQ(eroded_points(field, 2), (std::vector<std::uint32_t>{0, 2, 3, 4}));
  EXPECT_TRUE(eroded_points(field, 6).empty());
}

TEST(ErodedSurfaceTest, OfABallIsAConcentricBall) {
  const Eroded e = ball(0.1);
  for (double radius : {0.95, 0.8, 0.5, 0.25}) {
    const ErodedSurface found = e.surface(ball_level(radius));
    expect_solid_boundary(found.mesh);
    // Edges that leave the ball know E at one end only.
    const double tolerance = (radius > 0.9 ? 0.05 : 0.01) * 0.1;
    for (const Vec3& p : found.mesh.points) EXPECT_NEAR(norm(p), radius, tolerance);
    EXPECT_NEAR(found.volume, mesh_facts(found.mesh).volume, 1e-12);
    // Chords of a sphere: the deficit of an inscribed mesh.
    const double exact = 4 * kPi / 3 * radius * radius * radius;
    EXPECT_LT(found.volume, exact);
    EXPECT_NEAR(found.volume / exact, 1, 0.4 * 0.01 / (radius * radius));
    expect_sides(e, found.mesh, ball_level(radius), 0.2);
  }
}

TEST(ErodedSurfaceTest, ConvergesWithTheSquareOfTheSpacing) {
  const double exact = 4 * kPi / 3 * 0.7 * 0.7 * 0.7;
  const double coarse = exact - ball(0.16).surface(ball_level(0.7)).volume;
  const double fine = exact - ball(0.08).surface(ball_level(0.7)).volume;
  const double finer = exact - ball(0.04).surface(ball_level(0.7)).volume;
  EXPECT_GT(coarse / fine, 3);
  EXPECT_GT(fine / finer, 3);
  EXPECT_LT(finer / exact, 0.0015);
}

TEST(ErodedSurfaceTest, OfAnEllipsoidIsHomotheticInAnyFrame) {
  // Axes neither orthogonal nor right-handed.
  const auto lattice = [](const Solid& solid) {
    LatticeGrid grid;
    grid.axes = {Vec3{0.02, 0.001, 0}, Vec3{0.003, 0.0, 0.02}, Vec3{-0.002, 0.02, 0}};
    grid.dims = {70, 70, 70};
    grid.origin = -34.5 * (grid.axes[0] + (grid.axes[1] + grid.axes[2]));
    return make_lattice(solid, grid);
  };
  const Eroded e = computed(make_ellipsoid(3, 2, 1.5, 1280), lattice);
  constexpr double kRadius = 0.75;
  const ErodedSurface found = e.surface(9 * ball_level(kRadius));
  expect_solid_boundary(found.mesh);
  // 1280 triangles lie inside the ellipsoid by up to 0.5 % and are as many directions.
  for (const Vec3& p : found.mesh.points) EXPECT_NEAR(norm({p.x / 3, p.y / 2, p.z / 1.5}), kRadius, 0.01);
}

TEST(ErodedSurfaceTest, OfATorusHasItsHole) {
  const Mesh mesh = make_torus(2, 0.7, 1024);
  const double v0 = mesh_facts(mesh).volume;
  const Eroded coarse = computed(mesh, spaced(0.2)), fine = computed(mesh, spaced(0.1));
  for (double fraction : {0.001, 0.01, 0.03}) {
    const ErodedSurface found = fine.surface(fraction * v0);
    expect_solid_boundary(found.mesh, 1);
    expect_sides(fine, found.mesh, fraction * v0, 0.3);
    EXPECT_NEAR(coarse.surface(fraction * v0).volume / found.volume, 1, 0.02);
  }
}

TEST(ErodedSurfaceTest, OfABoxLiesOnTheLevel) {
  // Corners are cut off where 4.5 abc = level, so the true solid is within these bounds.
  const Eroded e = computed(make_box(3, 2, 1), spaced(0.08), "sphere:1280+triangles");
  for (double fraction : {0.001, 0.03, 0.2}) {
    const ErodedSurface found = e.surface(fraction * 6);
    expect_solid_boundary(found.mesh);
    expect_sides(e, found.mesh, fraction * 6, 0.3);
    for (const Vec3& p : found.mesh.points) {
      // The plane parallel to the nearest face cuts off at least the level, to an eighth of the spacing.
      EXPECT_GT((std::min(p.x, 3 - p.x) + 0.01) * 2, fraction * 6);
      EXPECT_GT((std::min(p.z, 1 - p.z) + 0.01) * 6, fraction * 6);
    }
  }
}

TEST(ErodedSurfaceTest, OfAHollowBallKeepsTheCavity) {
  // The wall of the cavity is concave: E has a limit above small levels there.
  const Eroded e = computed(hollow_ball(), spaced(0.2));
  const double level = 0.01 * e.solid.volume;
  const ErodedSurface found = e.surface(level);
  expect_manifold(found.mesh);
  const MeshFacts facts = mesh_facts(found.mesh);
  EXPECT_EQ(facts.components, 2u);
  EXPECT_EQ(facts.euler, 4);
  expect_sides(e, found.mesh, level, 0.3);
  std::size_t on_cavity = 0;
  for (const Vec3& p : found.mesh.points) {
    const double distance = norm(p - Vec3{0.5, 0, 0});
    on_cavity += distance < 1.001;
    EXPECT_GT(distance, 0.9);  // 80 triangles
    EXPECT_TRUE(distance < 1.001 || distance > 1.3);
  }
  EXPECT_GT(on_cavity, 100u);
}

TEST(ErodedSurfaceTest, OfTwoBallsIsInTwoPieces) {
  const Mesh one = make_sphere(1, 320);
  const Eroded e = computed(joined(one, moved(one, {2.05, 0, 0})), spaced(0.2));
  for (double radius : {0.95, 0.6}) {
    const MeshFacts facts = mesh_facts(e.surface(ball_level(radius)).mesh);
    EXPECT_TRUE(facts.closed && facts.oriented && facts.vertices_manifold);
    EXPECT_EQ(facts.components, 2u);
    EXPECT_EQ(facts.euler, 4);
    EXPECT_GT(facts.volume, 0);
  }
}

TEST(ErodedSurfaceTest, IsEmptyAboveTheHighestPoint) {
  const Eroded e = ball(0.3);
  const ErodedSurface found = e.surface(1.01 * e.most());
  EXPECT_TRUE(found.mesh.points.empty());
  EXPECT_TRUE(found.mesh.triangles.empty());
  EXPECT_EQ(found.volume, 0);
}

TEST(ErodedSurfaceTest, AtATinyLevelIsNearlyTheSolid) {
  struct Case {
    Mesh mesh;
    std::int64_t genus;
  };
  for (const Case& c : {Case{make_sphere(1.5, 320), 0}, Case{cup(24), 0}, Case{make_torus(2, 0.7, 512), 1}}) {
    const Eroded e = computed(c.mesh, spaced(0.11));
    const ErodedSurface found = e.surface(1e-12);
    expect_solid_boundary(found.mesh, c.genus);
    const MeshFacts whole = mesh_facts(c.mesh);
    // Sharp edges are cut off within a voxel; a tenth of a spacing over the whole surface is more.
    EXPECT_NEAR(found.volume, whole.volume, 0.1 * 0.11 * whole.area);
  }
}

TEST(ErodedSurfaceTest, VerticesAreWithinAVoxelOfTheErodedPoints) {
  const Eroded e = computed(cup(16), spaced(0.2));
  const double level = 0.01 * e.solid.volume;
  std::vector<Vec3> points;
  for_each_point(e, [&](std::uint32_t p, const Vec3& x) {
    if (e.field.erosion[p] >= level) points.push_back(x);
  });
  EXPECT_EQ(points.size(), eroded_points(e.field, level).size());
  for (const Vec3& v : e.surface(level).mesh.points) {
    double nearest = 1e300;
    for (const Vec3& x : points) nearest = std::min(nearest, norm(v - x));
    EXPECT_LE(nearest, 0.2 * std::sqrt(3.0));
  }
}

TEST(ErodedSurfaceTest, KeepsSolidsWithANarrowGapApart) {
  // No layer of sample points in the gap: they lie at 1.71 and 2.21.
  const Mesh mesh = joined(make_box(2, 4, 4), moved(make_box(1.9, 4, 4), {2.02, 0, 0}));
  const ErodedSurface found = uneroded(mesh, 0.5).surface(0.5);
  expect_manifold(found.mesh);
  EXPECT_EQ(mesh_facts(found.mesh).components, 2u);
  EXPECT_NEAR(found.volume, 62.4, 4);
  for (const Vec3& p : found.mesh.points) EXPECT_FALSE(p.x > 2.001 && p.x < 2.019);
}

TEST(ErodedSurfaceTest, ClosesTheEndOfANarrowSlit) {
  // A comb's teeth pushed together: slits 0.1 wide that end inside, between sample points 0.31 apart.
  Mesh mesh = comb(3);
  for (Vec3& p : mesh.points) {
    const double cell = std::floor(p.x / 2 + 1e-9);
    p = {cell * 1.1 + std::min(1.0, p.x - 2 * cell), 2 * p.y, p.z};
  }
  const ErodedSurface found = uneroded(mesh, 0.31).surface(0.5);
  expect_solid_boundary(found.mesh);
  std::size_t on_walls = 0;
  for (const Vec3& p : found.mesh.points) {
    if (p.z > 0.5 && p.z < 2.5) on_walls += std::abs(p.x - 1) < 1e-3 || std::abs(p.x - 1.1) < 1e-3;
  }
  EXPECT_GT(on_walls, 50u);
  EXPECT_NEAR(found.volume, mesh_facts(mesh).volume, 0.1 * mesh_facts(mesh).volume);
}

TEST(ErodedSurfaceTest, IsManifoldWhateverTheGaps) {
  // Many cavities of about a voxel that overlap each other: gaps on single edges in all combinations.
  std::mt19937_64 random(3);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Mesh mesh = make_box(10, 10, 10);
  for (int n = 0; n < 500; ++n) {
    const Vec3 centre{1.5 + 7 * uniform(), 1.5 + 7 * uniform(), 1.5 + 7 * uniform()};
    mesh = joined(mesh, reversed(moved(make_sphere(1, 20), centre, 0.1 + 0.8 * uniform())));
  }
  const Eroded e = uneroded(mesh, 1);
  for (double shortest : {0.0, 0.4}) {
    const ErodedSurface found =
        eroded_surface(e.solid, e.lattice, e.field, {.level = 0.5, .shortest_edge = shortest});
    expect_manifold(found.mesh);
    EXPECT_GT(mesh_facts(found.mesh).components, 1u);
    EXPECT_GT(found.volume, 0);
  }
}

TEST(ErodedSurfaceTest, IsManifoldWhateverTheField) {
  std::mt19937_64 random(5);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const Eroded e = given(
      cup(12), 0.25,
      [&](const Vec3&) { return uniform() < 0.05 ? std::numeric_limits<double>::infinity() : uniform(); },
      [&](const Vec3&) {
        return Vec3{8 * uniform() - 4, 8 * uniform() - 4, 8 * uniform() - 4};
      });
  for (double level : {0.0, 0.3, 0.7}) {
    const ErodedSurface found = e.surface(level);
    expect_manifold(found.mesh);
    EXPECT_GT(found.volume, 0);
  }
}

TEST(ErodedSurfaceTest, DependsOnTheSolidNotOnTheLengthOfTheLattice) {
  // A ball in two pieces with empty layers and rows between them, in lattices of 18 and of 2^18 layers or
  // rows.
  const Mesh two = joined(make_sphere(1, 320), moved(make_sphere(1, 320), {4, 3.5, 3}));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto lattice = [&](std::uint32_t length) {
      return [axis, length](const Solid& solid) {
        LatticeGrid grid;
        grid.axes = {Vec3{0.0625, 0, 0}, Vec3{0, 0.0625, 0}, Vec3{0, 0, 0.0625}};
        grid.origin = {-0.53125, -0.53125, -0.53125};
        grid.dims = {18, 18, 18};
        grid.dims[axis] = length;
        return make_lattice(solid, grid);
      };
    };
    const Eroded near = computed(two, lattice(18)), far = computed(two, lattice(1U << 18));
    const double level = 0.01 * near.solid.volume;
    const ErodedSurface expected = near.surface(level), found = far.surface(level);
    expect_manifold(found.mesh);
    EXPECT_EQ(mesh_facts(found.mesh).components, 2u);
    EXPECT_EQ(found.mesh.triangles.size(), expected.mesh.triangles.size());
    EXPECT_NEAR(found.volume / expected.volume, 1, 1e-9);
    expect_sides(near, found.mesh, level, 0.3);
  }
}

TEST(ErodedSurfaceTest, RefusesBadArguments) {
  Eroded e = ball(0.5);
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (double level : {-1.0, nan, infinity}) EXPECT_THROW(e.surface(level), CoreError);
  for (double shortest : {-0.1, 1.0, nan}) {
    EXPECT_THROW(eroded_surface(e.solid, e.lattice, e.field, {.level = 1, .shortest_edge = shortest}),
                 CoreError);
  }
  e.field.gradient.pop_back();
  EXPECT_THROW(e.surface(1), CoreError);
}

}  // namespace
}  // namespace affskel::core

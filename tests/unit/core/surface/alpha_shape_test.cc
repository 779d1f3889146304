#include "core/surface/alpha_shape.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "core/base/error.h"
#include "core/mesh_checks.h"
#include "core/stopping_context.h"

namespace affskel::core {
namespace {

// Neither is a binary fraction, so the coordinates below are rounded like a real lattice's.
constexpr double kSpacing = 0.3;
constexpr Vec3 kOrigin{-7.1, 0.1, 1234.7};

Vec3 node(int i, int j, int k) {
  return {kOrigin.x + i * kSpacing, kOrigin.y + j * kSpacing, kOrigin.z + k * kSpacing};
}

/// The nodes of [0, n)^3 for which `keep` holds.
std::vector<Vec3> nodes(int n, const std::function<bool(int, int, int)>& keep) {
  std::vector<Vec3> points;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      for (int k = 0; k < n; ++k) {
        if (keep(i, j, k)) points.push_back(node(i, j, k));
      }
    }
  }
  return points;
}

Mesh lattice_surface(const std::vector<Vec3>& points) {
  return alpha_shape(points, {.spacing = kSpacing});
}

/// Area in lattice squares.
double squares(const Mesh& mesh) {
  return mesh_facts(mesh).area / (kSpacing * kSpacing);
}
/// Volume in lattice cubes, of a closed surface far from the origin.
double cubes(Mesh mesh) {
  for (Vec3& p : mesh.points) p = p - kOrigin;
  return mesh_facts(mesh).volume / (kSpacing * kSpacing * kSpacing);
}

using Corners = std::array<std::array<double, 3>, 3>;

/// The triangles by their places, independent of the order of points.
std::vector<Corners> by_place(const Mesh& mesh) {
  std::vector<Corners> out;
  for (const Triangle& t : mesh.triangles) {
    Corners corners{};
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3& p = mesh.points[t[k]];
      corners[k] = {p.x, p.y, p.z};
    }
    std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
    out.push_back(corners);
  }
  std::sort(out.begin(), out.end());
  return out;
}

TEST(AlphaSurfaceTest, CoversAFlatSheetExactlyOnce) {
  const std::vector<Vec3> sheet = nodes(20, [](int, int j, int) { return j == 4; });
  const Mesh mesh = lattice_surface(sheet);
  EXPECT_EQ(mesh.points, sheet);
  EXPECT_EQ(mesh.triangles.size(), 2u * 19 * 19);
  EXPECT_NEAR(squares(mesh), 19 * 19, 1e-9);
  EXPECT_EQ(mesh_facts(mesh).euler, 1);  // a disc
  EXPECT_TRUE(mesh_facts(mesh).oriented);
}

TEST(AlphaSurfaceTest, CoversAFlatSheetOnceAmongOtherPoints) {
  std::vector<Vec3> points = nodes(20, [](int, int, int k) { return k == 4; });
  const Vec3 apart = node(3, 3, 17);
  points.push_back(apart);  // makes the triangulation three-dimensional
  const Mesh mesh = lattice_surface(points);
  EXPECT_EQ(mesh.triangles.size(), 2u * 19 * 19);
  EXPECT_NEAR(squares(mesh), 19 * 19, 1e-9);
  EXPECT_EQ(mesh_facts(mesh).euler, 1);
  EXPECT_TRUE(mesh_facts(mesh).oriented);
  EXPECT_EQ(std::count(mesh.points.begin(), mesh.points.end(), apart), 0);
}

TEST(AlphaSurfaceTest, CoversAnObliqueSheetOnce) {
  const Mesh mesh = lattice_surface(nodes(15, [](int i, int, int k) { return i == k; }));
  EXPECT_NEAR(squares(mesh), 14 * 14 * std::sqrt(2.0), 1e-9);
  EXPECT_EQ(mesh.triangles.size(), 2u * 14 * 14);
}

TEST(AlphaSurfaceTest, ThickensTheCrossingOfTwoSheetsOnly) {
  // Across the sheets the empty circles that touch both, of squared radius 1/2 and 5/2, are
  // below 3 - 1/4: the crossing becomes the prism |x| + |y| <= 2, 12 long, and hides its 5 x 11 inner nodes.
  const std::vector<Vec3> points = nodes(13, [](int i, int j, int) { return i == 6 || j == 6; });
  const Mesh mesh = lattice_surface(points);
  const double sheets = 4 * 4 * 12, prism = 4 * std::sqrt(8.0) * 12 + 2 * 8;
  EXPECT_NEAR(squares(mesh), sheets + prism, 1e-9);
  EXPECT_EQ(mesh.points.size(), points.size() - 5 * 11);
}

TEST(AlphaSurfaceTest, LeavesAHoleWiderThanAlphaOpen) {
  // A block of 5 x 5 missing nodes.  At each of its corners the empty circles of squared radius 1/2 and
  // 5/2 are below 3, the next, of 13/2, is not: a right triangle of area 2 is covered.
  const Mesh mesh = lattice_surface(
      nodes(16, [](int i, int j, int k) { return k == 0 && !(i >= 5 && i < 10 && j >= 5 && j < 10); }));
  EXPECT_NEAR(squares(mesh), 15 * 15 - (6 * 6 - 4 * 2), 1e-9);
  EXPECT_EQ(mesh_facts(mesh).euler, 0);  // an annulus
}

TEST(AlphaSurfaceTest, BoundsABlockOfNodes) {
  const Mesh mesh = lattice_surface(nodes(9, [](int, int, int) { return true; }));
  expect_solid_boundary(mesh);
  EXPECT_NEAR(squares(mesh), 6 * 8 * 8, 1e-9);
  EXPECT_NEAR(cubes(mesh), 8 * 8 * 8, 1e-9);
  EXPECT_EQ(mesh.points.size(), 9u * 9 * 9 - 7 * 7 * 7);
}

TEST(AlphaSurfaceTest, BoundsASlabTwoNodesThick) {
  const Mesh mesh = lattice_surface(nodes(12, [](int, int, int k) { return k < 2; }));
  expect_solid_boundary(mesh);
  EXPECT_NEAR(squares(mesh), 2 * 11 * 11 + 4 * 11, 1e-9);
  EXPECT_NEAR(cubes(mesh), 11 * 11, 1e-9);
}

TEST(AlphaSurfaceTest, BoundsABall) {
  constexpr int kRadius = 13;
  const Mesh mesh = lattice_surface(nodes(2 * kRadius + 1, [](int i, int j, int k) {
    const int x = i - kRadius, y = j - kRadius, z = k - kRadius;
    return x * x + y * y + z * z <= kRadius * kRadius;
  }));
  expect_solid_boundary(mesh);
  EXPECT_NEAR(squares(mesh) / (4 * std::numbers::pi * kRadius * kRadius), 1, 0.02);
  const double ball = 4 * std::numbers::pi / 3 * std::pow(kRadius, 3);
  EXPECT_LT(cubes(mesh), ball);
  EXPECT_GT(cubes(mesh), 0.9 * ball);
}

TEST(AlphaSurfaceTest, CountsDuplicatesOnce) {
  const std::vector<Vec3> once = nodes(6, [](int i, int j, int k) { return (i + j + k) % 4 != 0; });
  std::vector<Vec3> twice = once;
  twice.insert(twice.end(), once.rbegin(), once.rend());
  const Mesh expected = lattice_surface(once), found = lattice_surface(twice);
  EXPECT_EQ(found.points, expected.points);
  EXPECT_EQ(found.triangles, expected.triangles);
}

TEST(AlphaSurfaceTest, FindsTheSameTrianglesInAnyOrderOfPoints) {
  std::vector<Vec3> points =
      nodes(12, [](int i, int j, int k) { return (i * i + j * 3 + k * k * k) % 5 == 0; });
  const std::vector<Corners> expected = by_place(lattice_surface(points));
  EXPECT_GT(expected.size(), 100u);
  std::mt19937 random(1);
  std::shuffle(points.begin(), points.end(), random);
  EXPECT_EQ(by_place(lattice_surface(points)), expected);
}

TEST(AlphaSurfaceTest, HasNoTrianglesBelowThreePointsOrOnALine) {
  EXPECT_TRUE(lattice_surface({}).triangles.empty());
  EXPECT_TRUE(lattice_surface({node(0, 0, 0)}).triangles.empty());
  EXPECT_TRUE(lattice_surface({node(0, 0, 0), node(1, 0, 0)}).triangles.empty());
  EXPECT_TRUE(lattice_surface(std::vector<Vec3>(50, node(0, 0, 0))).triangles.empty());
  const Mesh line = lattice_surface(nodes(9, [](int i, int j, int k) { return i == j && j == k; }));
  EXPECT_TRUE(line.triangles.empty());
  EXPECT_TRUE(line.points.empty());
  EXPECT_EQ(lattice_surface({node(0, 0, 0), node(1, 0, 0), node(0, 1, 1)}).triangles.size(), 1u);
}

TEST(AlphaSurfaceTest, TakesRadiiEqualToAlpha) {
  // Regular tetrahedron of edge sqrt(8): squared circumradius 8/3 of the faces, 3 of the whole.
  const std::vector<Vec3> points{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  EXPECT_TRUE(alpha_shape(points, {.alpha = 2.66}).triangles.empty());
  EXPECT_EQ(alpha_shape(points, {.alpha = 8.0 / 3}).triangles.size(), 4u);
  EXPECT_EQ(alpha_shape(points, {.alpha = 2.99}).triangles.size(), 4u);
  const Mesh solid = alpha_shape(points, {.alpha = 3});
  expect_solid_boundary(solid);
  EXPECT_NEAR(mesh_facts(solid).volume, 8.0 / 3, 1e-14);
}

TEST(AlphaSurfaceTest, TakesPointsThatAreOnNoLattice) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vec3> ball;
  while (ball.size() < 4000) {
    const Vec3 p{uniform(random), uniform(random), uniform(random)};
    if (dot(p, p) <= 1) ball.push_back(p);
  }
  const Mesh mesh = alpha_shape(ball, {.alpha = 0.16, .spacing = 0.1});
  const MeshFacts facts = mesh_facts(mesh);
  EXPECT_TRUE(facts.balanced);
  EXPECT_NEAR(facts.volume / (4 * std::numbers::pi / 3), 0.95, 0.05);
}

TEST(AlphaSurfaceTest, StopsWhenAsked) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vec3> points(4000);
  for (Vec3& p : points) p = {uniform(random), uniform(random), uniform(random)};
  expect_stops_wherever_it_is_asked(
      30, [&](ExecutionContext* context) { alpha_shape(points, {.alpha = 0.16, .context = context}); });
}

TEST(AlphaSurfaceTest, RefusesBadArguments) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  const std::vector<Vec3> points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const AlphaShapeOptions& options :
       {AlphaShapeOptions{}, AlphaShapeOptions{.alpha = -1}, AlphaShapeOptions{.alpha = inf},
        AlphaShapeOptions{.alpha = nan}, AlphaShapeOptions{.spacing = -1},
        AlphaShapeOptions{.alpha = 1, .spacing = nan}}) {
    EXPECT_THROW(alpha_shape(points, options), CoreError) << options.alpha << ' ' << options.spacing;
  }
  const std::vector<Vec3> not_finite{{0, 0, 0}, {1, 0, nan}, {0, 1, 0}, {0, 0, 1}};
  EXPECT_THROW(alpha_shape(not_finite, {.alpha = 1}), CoreError);
}

}  // namespace
}  // namespace affskel::core

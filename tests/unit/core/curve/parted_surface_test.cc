#include "core/curve/parted_surface.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/collapse/dual_complex.h"
#include "core/collapse/lattice_solids.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/mesh/mesh_topology.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

Vec3 centroid(const Mesh& mesh, const Triangle& t) {
  return (1.0 / 3) * (mesh.points[t[0]] + (mesh.points[t[1]] + mesh.points[t[2]]));
}

// Of a solid of one part.
std::vector<std::uint32_t> points_under(const LatticeSolid& solid) {
  const std::vector<std::uint32_t> one(solid.lattice.points, 1);
  const PartedSurface surface = parted_surface(solid.solid, solid.lattice, one);
  EXPECT_EQ(surface.mesh.triangles, solid.solid.mesh.triangles);
  return surface.point;
}

// Against a search through all sample points.
TEST(PartedSurface, AreTheNearestToAPlaceInward) {
  const LatticeSolid torus(make_torus(3, 1, 400), 0.25);
  const Lattice& lattice = torus.lattice;
  const std::vector<std::uint32_t> found = points_under(torus);
  std::vector<std::uint32_t> ranks(lattice.points);
  for (std::uint32_t p = 0; p < ranks.size(); ++p) ranks[p] = p;
  std::vector<Vec3> places;
  for (const LatticePlace& at : lattice_places(lattice, ranks))
    places.push_back(scaled_place(lattice, {double(at[0]), double(at[1]), double(at[2])}));
  const Mesh& mesh = torus.solid.mesh;
  ASSERT_EQ(found.size(), mesh.triangles.size());
  const double half = 0.5 * lattice.spacing / torus.solid.scale();
  for (std::size_t t = 0; t < found.size(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    const Vec3 n = cross(mesh.points[b] - mesh.points[a], mesh.points[c] - mesh.points[a]);
    const Vec3 place = centroid(mesh, mesh.triangles[t]) - (half / norm(n)) * n;
    double least = 1e300;
    for (const Vec3& at : places) least = std::min(least, norm(at - place));
    ASSERT_NE(found[t], kNone);
    EXPECT_NEAR(norm(places[found[t]] - place), least, 1e-12);
  }
}

// Two plates with a gap of less than a step: each side of it has points of its own plate.
TEST(PartedSurface, AtAGapBelongToTheirOwnSide) {
  const Mesh plates = joined(make_box(4, 4, 1, 4), moved(make_box(4, 4, 1, 4), {0, 0, 1.1}));
  const LatticeSolid solid(plates, 0.2);
  const std::vector<std::uint32_t> found = points_under(solid);
  for (std::size_t t = 0; t < found.size(); ++t) {
    ASSERT_NE(found[t], kNone);
    const LatticePlace at = lattice_places(solid.lattice, {&found[t], 1})[0];
    const Vec3 place = scaled_place(solid.lattice, {double(at[0]), double(at[1]), double(at[2])});
    const double middle = 0;  // of the box of both
    const bool upper = t >= found.size() / 2;
    EXPECT_EQ(place.z > middle, upper) << t;
  }
}

// Ten steps long and a hundredth thick, between the planes of the lattice.
TEST(PartedSurface, AreNoneWhereTheLatticeHasNone) {
  const Mesh needle = joined(make_box(2, 2, 2, 2), moved(make_box(10, 0.01, 0.01), {1.5, 0.6, 0.6}));
  const LatticeSolid solid(needle, 0.5);
  const std::vector<std::uint32_t> found = points_under(solid);
  int none = 0;
  for (std::size_t t = 0; t < found.size(); ++t) none += found[t] == kNone;
  EXPECT_GT(none, 0);
  EXPECT_LT(none, 12);
}

double area(const Mesh& mesh, const Triangle& t) {
  const Vec3& a = mesh.points[t[0]];
  return 0.5 * norm(cross(mesh.points[t[1]] - a, mesh.points[t[2]] - a));
}

// A bar of twelve triangles in two parts, whose border goes slantwise across two of its sides.
TEST(PartedSurface, IsCutWherePartsMeet) {
  const double spacing = 0.1;
  const LatticeSolid bar(make_box(10, 1, 1), spacing);
  const double step = spacing / bar.solid.scale();
  const auto side = [&](const Vec3& at) { return at.x + at.y; };  // about the middle of the bar
  std::vector<std::uint32_t> part(bar.lattice.points), ranks(part.size());
  for (std::uint32_t p = 0; p < part.size(); ++p) ranks[p] = p;
  const std::vector<LatticePlace> places = lattice_places(bar.lattice, ranks);
  for (std::uint32_t p = 0; p < part.size(); ++p) {
    const auto& [i, j, k] = places[p];
    part[p] = side(scaled_place(bar.lattice, {double(i), double(j), double(k)})) < 0 ? 1 : 2;
  }
  const PartedSurface cut = parted_surface(bar.solid, bar.lattice, part);
  EXPECT_TRUE(every_edge_is_shared(cut.mesh));
  EXPECT_LT(cut.mesh.triangles.size(), 1500U);
  double areas[] = {0, 0}, volume = 0, least = 1e300;
  for (std::size_t t = 0; t < cut.mesh.triangles.size(); ++t) {
    const Triangle& triangle = cut.mesh.triangles[t];
    const std::uint32_t of = part[cut.point[t]];
    areas[of - 1] += area(cut.mesh, triangle);
    least = std::min(least, area(cut.mesh, triangle));
    const auto& [a, b, c] = triangle;
    volume += dot(cut.mesh.points[a], cross(cut.mesh.points[b], cut.mesh.points[c])) / 6;
    for (const std::uint32_t v : triangle)
      EXPECT_GT((of == 1 ? -1 : 1) * side(cut.mesh.points[v]), -3 * step) << t;
  }
  const double scale = bar.solid.scale(), square = scale * scale;
  EXPECT_NEAR(square * (areas[0] + areas[1]), 42, 1e-9);
  EXPECT_NEAR(square * areas[0], 21, 0.1);
  EXPECT_NEAR(square * scale * volume, 10, 1e-9);
  EXPECT_GT(square * least, 1e-5);
}

// What is smaller than the lattice's cells stays whole.
TEST(PartedSurface, KeepsTrianglesOfASpacing) {
  const LatticeSolid ball(make_sphere(1, 5000), 0.2);
  std::vector<std::uint32_t> part(ball.lattice.points);
  for (std::uint32_t p = 0; p < part.size(); ++p) part[p] = 1 + p % 2;
  EXPECT_EQ(parted_surface(ball.solid, ball.lattice, part).mesh.triangles, ball.solid.mesh.triangles);
}

}  // namespace
}  // namespace affskel::core

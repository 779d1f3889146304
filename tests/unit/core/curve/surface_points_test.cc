#include "core/curve/surface_points.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/collapse/dual_complex.h"
#include "core/collapse/lattice_solids.h"
#include "core/lattice/lattice_coordinates.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

Vec3 centroid(const Mesh& mesh, const Triangle& t) {
  return (1.0 / 3) * (mesh.points[t[0]] + (mesh.points[t[1]] + mesh.points[t[2]]));
}

// Against a search through all sample points.
TEST(SurfacePoints, AreTheNearestToAPlaceInward) {
  const LatticeSolid torus(make_torus(3, 1, 400), 0.25);
  const Lattice& lattice = torus.lattice;
  const std::vector<std::uint32_t> found = surface_points(torus.solid, lattice);
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
    ASSERT_NE(found[t], DualComplex::kNone);
    EXPECT_NEAR(norm(places[found[t]] - place), least, 1e-12);
  }
}

// Two plates with a gap of less than a step: each side of it has points of its own plate.
TEST(SurfacePoints, AtAGapBelongToTheirOwnSide) {
  const Mesh plates = joined(make_box(4, 4, 1, 4), moved(make_box(4, 4, 1, 4), {0, 0, 1.1}));
  const LatticeSolid solid(plates, 0.2);
  const std::vector<std::uint32_t> found = surface_points(solid.solid, solid.lattice);
  for (std::size_t t = 0; t < found.size(); ++t) {
    ASSERT_NE(found[t], DualComplex::kNone);
    const LatticePlace at = lattice_places(solid.lattice, {&found[t], 1})[0];
    const Vec3 place = scaled_place(solid.lattice, {double(at[0]), double(at[1]), double(at[2])});
    const double middle = 0;  // of the box of both
    const bool upper = t >= found.size() / 2;
    EXPECT_EQ(place.z > middle, upper) << t;
  }
}

// Ten steps long and a hundredth thick, between the planes of the lattice.
TEST(SurfacePoints, AreNoneWhereTheLatticeHasNone) {
  const Mesh needle = joined(make_box(2, 2, 2, 2), moved(make_box(10, 0.01, 0.01), {1.5, 0.6, 0.6}));
  const LatticeSolid solid(needle, 0.5);
  const std::vector<std::uint32_t> found = surface_points(solid.solid, solid.lattice);
  int none = 0;
  for (std::size_t t = 0; t < found.size(); ++t) none += found[t] == DualComplex::kNone;
  EXPECT_GT(none, 0);
  EXPECT_LT(none, 12);
}

}  // namespace
}  // namespace affskel::core

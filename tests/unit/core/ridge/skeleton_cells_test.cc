#include "core/ridge/skeleton_cells.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "core/collapse/lattice_solids.h"
#include "core/quality/sheet_topology.h"

namespace affskel::core {
namespace {

// The triangles and segments that a skeleton's mesh makes of the cells.
BettiNumbers topology_of(const SkeletonCells& cells) {
  Mesh mesh;
  mesh.points.resize(cells.vertices.size());
  mesh.triangles.assign(cells.fans.begin(), cells.fans.end());
  for (std::size_t s = 0; s < cells.rings.size(); ++s) {
    if (cells.fanned[s]) continue;
    const auto& [a, b, c, d] = cells.rings[s];
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  }
  std::vector<Segment> segments;
  for (std::size_t n = 0; n < cells.segments.size(); ++n)
    if (cells.squares_at[n] == 0) segments.push_back({cells.segments[n][0], cells.segments[n][1]});
  return sheet_betti_numbers(mesh, segments);
}

// Every cell but the cubes is left.  On lattices this coarse many gaps are thinner than the spacing, where cells of
// both sides have the same corners.
TEST(SkeletonCells, KeepTheTopologyWhereCellsHaveTheSameCorners) {
  std::uint64_t fanned = 0, split = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const LatticeSolid solid(random_solid(seed), 0.25);
    const DualComplex complex(solid.lattice);
    CellSet left(complex);
    std::uint64_t vertices = 0;
    complex.for_each_cell([&](DualComplex::Cell cell) {
      if (DualComplex::dimension(cell) < 3) left.insert(cell);
      vertices += DualComplex::dimension(cell) == 0;
    });
    const SkeletonCells cells(complex, left);
    const CellMesh own = mesh_of_cells(complex, left);
    EXPECT_EQ(topology_of(cells), sheet_betti_numbers(own.mesh, own.segments)) << seed;
    std::uint64_t centres = 0;
    for (const char with_centre : cells.fanned) centres += with_centre != 0;
    fanned += centres;
    split += cells.vertices.size() - vertices - centres;
  }
  EXPECT_GT(fanned, 0U);
  EXPECT_GT(split, 0U);
}

}  // namespace
}  // namespace affskel::core

#include "core/ridge/filled_tunnels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/collapse/collapse.h"
#include "core/collapse/lattice_solids.h"
#include "core/quality/sheet_topology.h"
#include "core/ridge/local_depth.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// A ball with a wide hollow in either side: a ring closed by a skin 0.04 thick, a share of the ball's radius.
Mesh skinned_ring() {
  Mesh mesh = make_sphere(1, 5120);
  for (Vec3& p : mesh.points) {
    const double out = std::hypot(p.x, p.y);
    p.z *= out < 0.5 ? 0.02 : 0.02 + 4 * (out - 0.5) * (out - 0.5);
  }
  return mesh;
}

struct Filled {
  BettiNumbers complex, skeleton;
  std::size_t filled = 0;
};

Filled filled(const Mesh& mesh, double spacing) {
  const LatticeSolid solid(mesh, spacing);
  const DualComplex complex(solid.lattice);
  const std::vector<float> radius = surface_distance(solid.lattice);
  CellSet left = collapse(complex, {}).cells;
  Filled result;
  result.complex = betti_numbers(complex);
  result.filled = fill_tunnels(solid.solid, solid.lattice, complex, {}, radius, left).edges.size();
  const CellMesh cells = mesh_of_cells(complex, left);
  result.skeleton = sheet_betti_numbers(cells.mesh, cells.segments);
  return result;
}

TEST(FillTunnels, FillsThatOfASkinThinnerThanTheSpacing) {
  const Filled ring = filled(skinned_ring(), 0.097);
  ASSERT_EQ(ring.complex, (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(ring.filled, 1U);
  EXPECT_EQ(ring.skeleton, (BettiNumbers{1, 0, 0}));
}

// The smaller loop is the solid's own, and stays.
TEST(FillTunnels, LeavesThoseOfTheSolid) {
  const Mesh both = joined(skinned_ring(), moved(make_torus(0.5, 0.2, 1024), {3, 0, 0}));
  const Filled rings = filled(both, 0.097);
  ASSERT_EQ(rings.complex, (BettiNumbers{2, 2, 0}));
  EXPECT_EQ(rings.filled, 1U);
  EXPECT_EQ(rings.skeleton, (BettiNumbers{2, 1, 0}));
  EXPECT_EQ(filled(make_torus(2, 0.6, 1024), 0.2).filled, 0U);
}

// Loops of surfaces within the solid tell nothing of its outside.
TEST(FillTunnels, FillsNothingWhereTheSurfaceCrossesItself) {
  const Mesh crossing = joined(skinned_ring(), moved(make_box(0.3, 0.3, 0.3), {0.7, 0, -0.1}));
  EXPECT_EQ(filled(crossing, 0.097).filled, 0U);
}

}  // namespace
}  // namespace affskel::core

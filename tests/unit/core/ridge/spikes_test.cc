#include "core/ridge/noisy_limbs.h"

#include <gtest/gtest.h>

#include "core/base/matrix3.h"
#include "core/collapse/lattice_solids.h"
#include "core/ridge/local_depth.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

// A beam along x, the box's low corner at the origin; its tips are the lattice's first and last vertices.
TEST(NoisyLimbs, AreThoseAboutWhoseTipsTheSurfaceCrossesItself) {
  LatticeSolid beam(make_box(20, 2, 2, 20), 0.5);
  const DualComplex complex(beam.lattice);
  const std::vector<float> radius = surface_distance(beam.lattice);
  Mesh walls = beam.solid.mesh;
  const LatticeGrid& grid = beam.lattice.grid;
  for (Vec3& p : walls.points) p = transposed_times(inverse_transposed(grid.axes), p - grid.origin);
  std::vector<LimbTip> tips(2);
  tips[0].vertex = complex.cell(0, DualComplex::kUpperVertex);
  complex.for_each_cell([&](DualComplex::Cell cell) {
    if (DualComplex::dimension(cell) == 0 && complex.star(cell).count == 8) tips[1].vertex = cell;
  });
  EXPECT_TRUE(noisy_limbs(beam.solid, walls, beam.lattice, complex, radius, tips).empty());
  for (std::uint32_t t = 0; t < walls.triangles.size(); ++t) {
    const Vec3 middle =
        (1.0 / 3) * (walls.points[walls.triangles[t][0]] + walls.points[walls.triangles[t][1]] +
                     walls.points[walls.triangles[t][2]]);
    if (middle.x < 8)  // spacings
      beam.solid.crossings.emplace_back(t, t);
  }
  ASSERT_FALSE(beam.solid.crossings.empty());
  EXPECT_EQ(noisy_limbs(beam.solid, walls, beam.lattice, complex, radius, tips), (std::vector<char>{1, 0}));
}

}  // namespace
}  // namespace affskel::core

#include "core/lattice/lattice_edges.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "core/chords/chord_fields.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Every place of the lattice's box: found where the walk over all edges comes by, with the same ends, and
// nowhere else.
void expect_the_walks_edges(const Lattice& lattice) {
  using Edge = std::pair<std::uint8_t, std::array<std::uint32_t, 3>>;
  std::map<Edge, std::array<std::uint32_t, 2>> walked;
  for_each_edge(lattice, [&](std::uint32_t x, std::uint32_t y, std::uint8_t axis, const auto& place) {
    walked[{axis, place}] = {x, y};
  });
  ASSERT_FALSE(walked.empty());
  const auto& dims = lattice.grid.dims;
  std::size_t found = 0;
  for (std::uint32_t i = 0; i < dims[0]; ++i) {
    for (std::uint32_t j = 0; j < dims[1]; ++j) {
      for (std::uint32_t k = 0; k < dims[2]; ++k) {
        for (std::uint8_t axis = 0; axis < 3; ++axis) {
          const std::array<std::uint32_t, 3> place{i, j, k};
          const auto ends = ends_of_edge(lattice, axis, place);
          const auto expected = walked.find({axis, place});
          ASSERT_EQ(ends.has_value(), expected != walked.end()) << i << " " << j << " " << k;
          if (!ends) continue;
          EXPECT_EQ(*ends, expected->second);
          ++found;
        }
      }
    }
  }
  EXPECT_EQ(found, walked.size());
}

TEST(LatticeEdges, IsFoundWhereTheWalkComesBy) {
  expect_the_walks_edges(BoxLattice(3, 4, 5).lattice);
}

TEST(LatticeEdges, IsFoundAcrossGapsAndHoles) {
  const double h = 0.23;
  const ErodedSolid torus(make_torus(3, 1, 256), {Vec3{h, 0, 0}, Vec3{0, h, 0}, Vec3{0, 0, h}}, "triangles");
  expect_the_walks_edges(torus.lattice);
}

TEST(LatticeEdges, IsFoundAcrossSurfacesInsideTheSolid) {
  const BoxLattice box(overlapping_boxes(5, 5, 9));
  ASSERT_GT(box.lattice.axis[2].runs.size(), 25U);
  expect_the_walks_edges(box.lattice);
}

}  // namespace
}  // namespace affskel::core

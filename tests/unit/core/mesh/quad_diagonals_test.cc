#include "core/mesh/quad_diagonals.h"

#include <gtest/gtest.h>

#include "core/solid/solid.h"
#include "core/text/off_file.h"

namespace affskel::core {
namespace {

// A roof over the rhombus 0 1 2 3, of two quadrilaterals that meet in the two edges at its ridge 4, and a
// pyramid below.  The shorter diagonal of both is 0-2.
constexpr const char* kRoof =
    "OFF\n6 6 0\n-1 0 0\n0 -3 0\n1 0 0\n0 3 0\n0 0 0.5\n0 0 -2\n"
    "4 0 1 2 4\n4 0 4 2 3\n3 1 0 5\n3 2 1 5\n3 3 2 5\n3 0 3 5\n";

TEST(QuadDiagonals, TurnsWhatWouldHoldATriangleTwice) {
  std::vector<Triangle> triangles = {{0, 1, 3}, {1, 2, 3}, {3, 1, 4}};
  // Quadrilateral 0 1 2 3 cut along 1-3, which is an edge of another triangle, too.
  const std::vector<std::uint32_t> quads = {0};
  EXPECT_EQ(turn_doubled_diagonals(quads, triangles), 1u);
  EXPECT_EQ(triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(triangles[1], (Triangle{2, 3, 0}));
  EXPECT_EQ(triangles[2], (Triangle{3, 1, 4}));
  EXPECT_EQ(turn_doubled_diagonals(quads, triangles), 0u) << "once is enough";
}

TEST(QuadDiagonals, LeavesProperCutsAndThoseWithoutAnotherWay) {
  const std::vector<Triangle> alone = {{0, 1, 3}, {1, 2, 3}};
  std::vector<Triangle> triangles = alone;
  const std::vector<std::uint32_t> quads = {0};
  EXPECT_EQ(turn_doubled_diagonals(quads, triangles), 0u);
  EXPECT_EQ(triangles, alone);
  const std::vector<Triangle> crowded = {{0, 1, 3}, {1, 2, 3}, {3, 1, 4}, {0, 2, 5}};
  triangles = crowded;
  EXPECT_EQ(turn_doubled_diagonals(quads, triangles), 0u) << "0-2 is an edge, too";
  EXPECT_EQ(triangles, crowded);
}

TEST(QuadDiagonals, QuadrilateralsOverTheSameTwoEdgesBoundASolid) {
  const OffMesh off = read_off(kRoof);
  EXPECT_EQ(off.polygons_cut, 2u);
  EXPECT_EQ(off.mesh.triangles.size(), 8u);
  // 4 below the rhombus; of the 1 that two turned diagonals would add, the turned one adds half.
  EXPECT_DOUBLE_EQ(make_solid(off.mesh).volume, 4.5);
}

}  // namespace
}  // namespace affskel::core

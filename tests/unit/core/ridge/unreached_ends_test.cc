#include "core/ridge/unreached_ends.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/collapse/lattice_solids.h"
#include "core/shapes/shapes.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// A box of side 4 with a needle of length 5 on top, 0.1 thick.
Mesh with_needle() {
  return joined(make_box(4, 4, 4), moved(make_box(0.1, 0.1, 6), {1.83, 2.13, 3}));
}

TEST(UnreachedEnds, AreWhereTheLatticeIsTooCoarse) {
  const LatticeSolid solid(with_needle(), 0.5);
  const std::vector<char> left_out(solid.lattice.points, 0);
  const std::vector<Vec3> skeleton{{2, 2, 1}, {2, 2, 2}};
  const auto ends = unreached_ends(solid.solid, solid.lattice, left_out, skeleton);
  ASSERT_EQ(ends.size(), 1U);
  EXPECT_EQ(ends[0].place.z, 9);
  EXPECT_DOUBLE_EQ(ends[0].distance, norm(ends[0].place - skeleton[1]));
}

TEST(UnreachedEnds, AreNoneOnAFineLattice) {
  const LatticeSolid solid(with_needle(), 0.045);
  const std::vector<char> left_out(solid.lattice.points, 0);
  EXPECT_TRUE(unreached_ends(solid.solid, solid.lattice, left_out, std::vector<Vec3>{{2, 2, 2}}).empty());
}

// A solid of which no point has a skeleton is an end as a whole; the farthest end comes first.
TEST(UnreachedEnds, AreWhatIsLeftOut) {
  const LatticeSolid solid(joined(make_box(4, 4, 4), moved(make_box(2, 2, 2), {8, 0, 0})), 0.3);
  std::vector<char> left_out(solid.lattice.points, 1);
  const std::vector<Vec3> skeleton{{2, 2, 2}};
  const auto both = unreached_ends(solid.solid, solid.lattice, left_out, skeleton);
  ASSERT_EQ(both.size(), 2U);
  EXPECT_EQ(both[0].place.x, 10);
  EXPECT_DOUBLE_EQ(both[1].distance, norm(Vec3{2, 2, 2}));
}

}  // namespace
}  // namespace affskel::core

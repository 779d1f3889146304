#include "core/solid/surface_loops.h"

#include <gtest/gtest.h>

#include <set>

#include "core/mesh/edges.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

TEST(SurfaceLoops, AreTwoForEachOfTheGenusAndRunAlongEdges) {
  const Mesh torus = make_torus(3, 1, 512);
  const Mesh solids = joined(joined(torus, moved(torus, {20, 0, 0})), moved(make_sphere(1, 80), {40, 0, 0}));
  const Mesh mesh = make_solid(solids).mesh;
  const auto loops = surface_loops(mesh);
  ASSERT_EQ(loops.size(), 4U);
  const Edges edges(mesh.points.size(), mesh.triangles);
  for (const auto& loop : loops) {
    const std::set<std::uint32_t> once(loop.begin(), loop.end());
    EXPECT_EQ(once.size(), loop.size());
    EXPECT_GE(loop.size(), 3U);
    for (std::size_t n = 0; n < loop.size(); ++n)
      EXPECT_EQ(edges.between(loop[n], loop[(n + 1) % loop.size()]).size(), 2U);
  }
}

TEST(SurfaceLoops, OfBallsAreNone) {
  EXPECT_TRUE(surface_loops(make_solid(hollow_ball()).mesh).empty());
}

}  // namespace
}  // namespace affskel::core

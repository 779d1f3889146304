#include "core/tidy/loose_vertices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/shapes/shapes.h"
#include "core/stopping_context.h"

namespace affskel::core {
namespace {

// The vertices inside the face z = 4 of a box, free to move up and down between `least` and `most`, and
// started off the face by steps of a third.
std::vector<LooseVertex> roughen_top(Mesh& mesh, double least, double most) {
  std::vector<LooseVertex> loose;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    Vec3& p = mesh.points[v];
    if (p.z < 4 || std::min({p.x, p.y, 4 - p.x, 4 - p.y}) < 0.1) continue;
    const double share = std::clamp(0.5 + (v % 3 == 0 ? 0.3 : -0.3), least, most);
    loose.push_back({v, {p.x - 0.1, p.y, 3.75}, {0.2, 0, 0.5}, least, most, share});
    p = loose.back().from + share * loose.back().along;
  }
  return loose;
}

TEST(LooseVerticesTest, EvenOutToThePlaneOfTheirSurroundings) {
  Mesh mesh = make_box(4, 4, 4, 8);
  const Mesh before = mesh;
  std::vector<LooseVertex> loose = roughen_top(mesh, 0, 1);
  ASSERT_GT(loose.size(), 30u);
  relax_loose_vertices(loose, 200, mesh);
  std::size_t next = 0;
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (next < loose.size() && loose[next].vertex == v) {
      ++next;
      EXPECT_NEAR(mesh.points[v].z, 4, 1e-3);
    } else {
      EXPECT_EQ(mesh.points[v], before.points[v]);
    }
  }
}

TEST(LooseVerticesTest, StayWithinTheirBounds) {
  Mesh mesh = make_box(4, 4, 4, 8);
  std::vector<LooseVertex> loose = roughen_top(mesh, 0.6, 0.9);
  relax_loose_vertices(loose, 50, mesh);
  for (const LooseVertex& l : loose) {
    EXPECT_GE(l.share, 0.6);
    EXPECT_LT(l.share, 0.7);  // the plane round it is at 0.5
    EXPECT_EQ(mesh.points[l.vertex], l.from + l.share * l.along);
  }
}

TEST(LooseVerticesTest, StopWhenAsked) {
  const Mesh box = make_box(4, 4, 4, 8);
  expect_stops_wherever_it_is_asked(50, [&](ExecutionContext* context) {
    Mesh mesh = box;
    std::vector<LooseVertex> loose = roughen_top(mesh, 0.6, 0.9);
    relax_loose_vertices(loose, 50, mesh, context);
  });
}

}  // namespace
}  // namespace affskel::core

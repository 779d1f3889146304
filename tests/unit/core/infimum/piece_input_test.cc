#include "core/infimum/piece_input.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/test_solids.h"

namespace affskel::core {
namespace {

// Of all edges of triangles, by growing each shell's tree by the shortest edge that leaves it (Prim 1957).
double length_of_shortest_trees(const Mesh& mesh) {
  std::vector<char> reached(mesh.points.size(), 0);
  double sum = 0;
  for (std::uint32_t root = 0; root < reached.size(); ++root) {
    if (reached[root] != 0) continue;
    reached[root] = 1;
    while (true) {
      double shortest = std::numeric_limits<double>::infinity();
      std::uint32_t next = 0;
      for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t a : t)
          for (const std::uint32_t b : t)
            if (reached[a] != 0 && reached[b] == 0 && norm(mesh.points[a] - mesh.points[b]) < shortest) {
              shortest = norm(mesh.points[a] - mesh.points[b]);
              next = b;
            }
      if (shortest == std::numeric_limits<double>::infinity()) break;
      reached[next] = 1;
      sum += shortest;
    }
  }
  return sum;
}

TEST(PieceInput, ItsTreesAreTheShortest) {
  const Mesh box = make_box(1, 2, 3, 4), ring = make_torus(3, 1, 200);
  for (const Mesh& mesh : {box, ring, joined(box, moved(make_box(2, 1, 1, 3), {10, 0, 0}))}) {
    const PieceInput input(make_solid(mesh));
    double sum = 0;
    for (std::uint32_t v = 0; v < input.mesh.points.size(); ++v)
      sum += norm(input.mesh.points[input.edges[v].begin] - input.mesh.points[input.edges[v].end]);
    EXPECT_NEAR(sum, length_of_shortest_trees(input.mesh), 1e-9);
    for (const PieceInput::Shell& shell : input.shells)
      EXPECT_EQ(input.edges[shell.root].begin, input.edges[shell.root].end) << "of a root";
  }
}

}  // namespace
}  // namespace affskel::core

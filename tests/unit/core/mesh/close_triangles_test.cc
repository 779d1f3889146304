#include "core/mesh/close_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/split_mix64.h"
#include "core/mesh/self_intersection.h"
#include "core/shapes/shapes.h"

namespace affskel::core {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// Every pair on its own, where no fan is large.
Pairs pairs_one_by_one(const Mesh& mesh) {
  Pairs pairs;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::uint32_t j = i + 1; j < mesh.triangles.size(); ++j) {
      Mesh two;
      std::vector<std::uint32_t> known;
      for (const std::uint32_t t : {i, j}) {
        Triangle corners = mesh.triangles[t];
        for (std::uint32_t& v : corners) {
          const auto at = std::find(known.begin(), known.end(), v);
          const auto place = static_cast<std::uint32_t>(at - known.begin());
          if (at == known.end()) {
            known.push_back(v);
            two.points.push_back(mesh.points[v]);
          }
          v = place;
        }
        two.triangles.push_back(corners);
      }
      if (!self_intersections(two, {.max_pairs = 1}).empty()) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

Pairs all_pairs(const Mesh& mesh) {
  return self_intersections(mesh, {.max_pairs = std::numeric_limits<std::size_t>::max()});
}

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}
  std::uint32_t below(std::uint32_t bound) { return static_cast<std::uint32_t>(random_.next() % bound); }
  // On a coarse grid, where sides meet, lie in one plane and on one line.
  Vec3 on_grid() {
    const auto coordinate = [this] { return static_cast<double>(below(7)) - 3; };
    return {coordinate(), coordinate(), coordinate()};
  }
  Vec3 anywhere() { return {random_.symmetric(), random_.symmetric(), random_.symmetric()}; }

 private:
  SplitMix64 random_;
};

// Two vertices, 0 and 1, with fans of 80 triangles each, both to sides of the same points and some over the
// edge between them, among others.
Mesh drawn_fans(std::uint64_t seed) {
  Draw draw(seed);
  const bool grid = seed % 2 == 0;
  Mesh mesh;
  for (int p = 0; p < 40; ++p) mesh.points.push_back(grid ? draw.on_grid() : draw.anywhere());
  const auto other = [&](std::uint32_t least) { return least + draw.below(40 - least); };
  for (int t = 0; t < 200; ++t) {
    const std::uint32_t first = t % 5 < 2 ? 0 : t % 5 < 4 ? 1 : other(2);
    const std::uint32_t second = t % 40 == 0 ? 1 : other(2);
    mesh.triangles.push_back({first, second, other(2)});
    std::rotate(mesh.triangles.back().begin(), mesh.triangles.back().begin() + draw.below(3),
                mesh.triangles.back().end());
  }
  return mesh;
}

TEST(CloseTriangles, LargeFansHideNoPair) {
  for (std::uint64_t seed = 0; seed < 12; ++seed) {
    const Mesh mesh = drawn_fans(seed);
    const Pairs pairs = all_pairs(mesh);
    EXPECT_GT(pairs.size(), 100u);
    EXPECT_EQ(pairs, pairs_one_by_one(mesh)) << seed;
  }
}

// A fan of slivers round the origin with a rim of `sides` points, in the plane or on a cone, and a second
// layer of the same rim shifted by half a side.
Mesh slivers(std::uint32_t sides, double height, double shift) {
  Mesh mesh;
  mesh.points.push_back({0, 0, 0});
  for (std::uint32_t layer = 0; layer < 2; ++layer) {
    for (std::uint32_t s = 0; s < sides; ++s) {
      const double angle = 2 * 3.14159265358979 * (s + shift * layer) / sides;
      mesh.points.push_back({std::cos(angle), std::sin(angle), height});
    }
    const std::uint32_t first = 1 + layer * sides;
    for (std::uint32_t s = 0; s < sides; ++s)
      mesh.triangles.push_back({0, first + s, first + (s + 1) % sides});
  }
  return mesh;
}

TEST(CloseTriangles, SliversThatOverlapRoundAVertexAreSeen) {
  for (const double height : {0.0, 1e-3, 0.75, 1e4}) {
    for (const double shift : {0.0, 0.5, 2.25}) {
      const Mesh mesh = slivers(100, height, shift);
      const Pairs pairs = all_pairs(mesh);
      EXPECT_EQ(pairs, pairs_one_by_one(mesh)) << height << " " << shift;
      // Each overlaps two of the other layer.
      if (height == 0 && shift == 0.5) {
        EXPECT_EQ(pairs.size(), 200u);
      }
    }
  }
}

// Triangles visited from all others.
std::uint64_t visits(const Mesh& mesh) {
  const std::vector<Box> boxes = boxes_of(mesh);
  const CloseTriangles close(mesh, boxes);
  std::uint64_t count = 0;
  for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
    std::set<std::uint32_t> seen;
    close.visit_above(i, [&](std::uint32_t j) {
      EXPECT_GT(j, i);
      seen.insert(j);
      ++count;
    });
  }
  return count;
}

TEST(CloseTriangles, FewAreCloseInAConeOfAnyNumberOfSides) {
  for (const double height : {0.01, 1.0, 100.0}) {
    for (const int sides : {1000, 16000}) {
      const Mesh cone = make_cone(1, height, sides);
      EXPECT_LT(visits(cone), 60 * cone.triangles.size()) << height << " " << sides;
    }
  }
}

}  // namespace
}  // namespace affskel::core

#include "core/spatial/close_triangles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/affine_map.h"
#include "core/base/split_mix64.h"
#include "core/mesh/perturb.h"
#include "core/shapes/shapes.h"
#include "core/spatial/self_intersection.h"

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

Mesh mapped(Mesh mesh, const AffineMap& map) {
  for (Vec3& p : mesh.points) p = map(p);
  return mesh;
}

// No axis, and no plane of two, is left as it was.
const AffineMap kTilt = then(rotation(0, 37), rotation(2, 11));

TEST(CloseTriangles, ObliqueSliversHideNoPair) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    for (const Mesh& shape : {make_cylinder(1, 3, 48), make_cone(1, 40, 90)}) {
      // Stretched, the triangles of the caps are slivers, too.
      const Mesh tilted = mapped(shape, then(scaling(1, 200, 1), kTilt));
      const Mesh mesh = perturb(tilted, {.sigma = 0.3, .seed = seed});
      const Pairs pairs = all_pairs(mesh);
      EXPECT_GT(pairs.size(), 20u) << seed;
      EXPECT_EQ(pairs, pairs_one_by_one(mesh)) << seed;
    }
  }
}

// Slivers anywhere, some with common vertices, some without width, among a few triangles that are none.
Mesh drawn_slivers(std::uint64_t seed) {
  Draw draw(seed);
  Mesh mesh;
  for (int t = 0; t < 250; ++t) {
    const Vec3 start = draw.anywhere(), along = draw.anywhere();
    const Vec3 across = (t % 10 == 0 ? 0.3 : t % 10 == 1 ? 0 : 1e-3) * draw.anywhere();
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (const Vec3& p : {start, start + along, start + across}) mesh.points.push_back(p);
    mesh.triangles.push_back({first, first + 1, first + 2});
    if (t % 3 == 0) mesh.triangles.back()[draw.below(3)] = draw.below(first + 1);
  }
  return mesh;
}

TEST(CloseTriangles, DrawnSliversHideNoPairAtAnyScale) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Mesh mesh = drawn_slivers(seed);
    const Pairs pairs = pairs_one_by_one(mesh);
    EXPECT_GT(pairs.size(), 20u) << seed;
    EXPECT_EQ(all_pairs(mesh), pairs) << seed;
    for (const double scale : {0x1p1023, 0x1p-1000, 0x1p-1023}) {
      EXPECT_EQ(all_pairs(mapped(mesh, scaling(scale, scale, scale))), pairs) << seed << " " << scale;
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
      EXPECT_LT(visits(mapped(cone, kTilt)), 60 * cone.triangles.size()) << height << " " << sides;
    }
  }
}

TEST(CloseTriangles, FewAreCloseInATiltedCylinderOfAnyNumberOfSides) {
  const AffineMap narrowed = then(scaling(1, 0.25, 1), shear(0, 2, 0.5));
  for (const int sides : {1000, 16000}) {
    const Mesh cylinder = make_cylinder(1, 3, static_cast<std::uint32_t>(sides));
    for (const AffineMap& map : {AffineMap{}, kTilt, then(narrowed, kTilt)}) {
      EXPECT_LT(visits(mapped(cylinder, map)), 60 * cylinder.triangles.size()) << sides;
    }
  }
}

// Slivers whose directions turn round the axis.
TEST(CloseTriangles, FewAreCloseInATiltedFrustumOfAnyNumberOfSides) {
  for (const int sides : {1000, 16000}) {
    Mesh frustum = make_cylinder(1, 3, static_cast<std::uint32_t>(sides));
    for (Vec3& p : frustum.points) p = kTilt(p.z > 0 ? Vec3{0.3 * p.x, 0.3 * p.y, p.z} : p);
    EXPECT_LT(visits(frustum), 60 * frustum.triangles.size()) << sides;
  }
}

// A ball beside a fence of slivers whose boxes hold it, before it and after it in the order of triangles.
TEST(CloseTriangles, OfABallFewAreCloseToSliversThatPassBy) {
  for (const bool ball_first : {true, false}) {
    const Mesh ball = mapped(make_sphere(0.2, 5000), translation({0, 0.5, -0.5}));
    Mesh mesh = ball_first ? ball : Mesh{};
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    for (std::uint32_t k = 0; k < 5000; ++k) {
      const Vec3 start = Vec3{-1, -1, -1} + k * Vec3{4e-4, -4e-4, 0};
      for (const Vec3& p : {start, start + Vec3{2, 2, 2}, start + Vec3{2e-4, -2e-4, 0}})
        mesh.points.push_back(p);
      mesh.triangles.push_back({first + 3 * k, first + 3 * k + 1, first + 3 * k + 2});
    }
    const auto offset = static_cast<std::uint32_t>(mesh.points.size());
    if (!ball_first) {
      mesh.points.insert(mesh.points.end(), ball.points.begin(), ball.points.end());
      for (const Triangle& t : ball.triangles)
        mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
    }
    EXPECT_LT(visits(mesh), 60 * mesh.triangles.size());
  }
}

}  // namespace
}  // namespace affskel::core

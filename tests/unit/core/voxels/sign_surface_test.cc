#include "core/voxels/sign_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <set>
#include <vector>

#include "core/mesh_checks.h"
#include "core/spatial/self_intersection.h"

namespace affskel::core {
namespace {

constexpr std::size_t kSide = 9;  // nodes

using Node = std::array<std::size_t, 3>;

// Values at nodes, positive at the outermost ones, interpolated linearly along each axis.
struct Values {
  std::vector<double> at = std::vector<double>(kSide * kSide * kSide, 1);

  template <class Draw>
  explicit Values(const Draw& draw) {
    for (std::size_t i = 1; i + 1 < kSide; ++i)
      for (std::size_t j = 1; j + 1 < kSide; ++j)
        for (std::size_t k = 1; k + 1 < kSide; ++k) at[number({i, j, k})] = draw();
  }
  static std::size_t number(const Node& n) { return (n[0] * kSide + n[1]) * kSide + n[2]; }
  double operator[](const Node& n) const { return at[number(n)]; }
  double operator()(const Vec3& p) const {
    Node low{};
    std::array<double, 3> part{};
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(kSide - 2, static_cast<std::size_t>(p[a]));
      part[a] = p[a] - static_cast<double>(low[a]);
    }
    double sum = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
      double weight = 1;
      Node n = low;
      for (std::size_t a = 0; a < 3; ++a) {
        n[a] += corner >> a & 1;
        weight *= (corner >> a & 1) != 0 ? part[a] : 1 - part[a];
      }
      if (weight != 0) sum += weight * (*this)[n];
    }
    return sum;
  }
};

// Euler number of the inner side, counted over the simplices with inner corners alone of a complex of twelve tetrahedra
// in each cube: over the halves of faces, with a tip in the middle.
std::int64_t euler_of_inner(const Values& values) {
  std::set<std::vector<std::size_t>> simplices;
  const auto for_each_corner = [](const Node& low, std::size_t axes, const auto& body) {
    for (std::size_t corner = 0; corner < 8; ++corner) {
      if ((corner & ~axes) != 0) continue;
      body(Node{low[0] + (corner & 1), low[1] + (corner >> 1 & 1), low[2] + (corner >> 2 & 1)});
    }
  };
  const auto add = [&](const std::array<Node, 3>& triangle, std::size_t middle, bool middle_inner) {
    for (std::size_t subset = 1; subset < 16; ++subset) {
      std::vector<std::size_t> simplex;
      bool inner = (subset & 8) == 0 || middle_inner;
      for (std::size_t i = 0; i < 3; ++i) {
        if ((subset >> i & 1) == 0) continue;
        simplex.push_back(Values::number(triangle[i]));
        inner = inner && values[triangle[i]] < 0;
      }
      if ((subset & 8) != 0) simplex.push_back(middle);
      std::sort(simplex.begin(), simplex.end());
      if (inner) simplices.insert(simplex);
    }
  };
  for (std::size_t i = 0; i + 1 < kSide; ++i) {
    for (std::size_t j = 0; j + 1 < kSide; ++j) {
      for (std::size_t k = 0; k + 1 < kSide; ++k) {
        double sum = 0;
        for_each_corner({i, j, k}, 7, [&](const Node& n) { sum += values[n]; });
        for (std::size_t face = 0; face < 6; ++face) {
          Node low{i, j, k};
          low[face / 2] += face % 2;
          std::vector<Node> q;
          for_each_corner(low, 7U & ~(1U << face / 2), [&](const Node& n) { q.push_back(n); });
          const auto inner = [&](std::size_t n) { return values[q[n]] < 0; };
          const double mean = values[q[0]] + values[q[3]] + (values[q[1]] + values[q[2]]);
          // The diagonal from 0 to 3 unless that from 1 to 2 is the one that joins.
          const bool both = inner(0) == inner(3) && inner(1) == inner(2) && inner(0) != inner(1);
          const bool other = both ? inner(0) != (mean < 0) : inner(1) == inner(2);
          const std::size_t middle = values.at.size() + Values::number({i, j, k});
          if (!other) {
            add({q[0], q[3], q[1]}, middle, sum < 0);
            add({q[0], q[3], q[2]}, middle, sum < 0);
          } else {
            add({q[1], q[2], q[0]}, middle, sum < 0);
            add({q[1], q[2], q[3]}, middle, sum < 0);
          }
        }
      }
    }
  }
  std::int64_t euler = 0;
  for (const auto& simplex : simplices) euler += simplex.size() % 2 == 1 ? 1 : -1;
  return euler;
}

void expect_right(const Values& values) {
  const Mesh mesh = sign_surface(values, {{0, 0, 0}, 1, {kSide, kSide, kSide}});
  const MeshFacts facts = mesh_facts(mesh);
  EXPECT_TRUE(facts.closed && facts.oriented && facts.vertices_manifold);
  EXPECT_EQ(facts.unused_vertices, 0U);
  EXPECT_EQ(facts.euler, 2 * euler_of_inner(values));
  EXPECT_TRUE(self_intersections(mesh).empty());
  for (std::size_t i = 0; i < kSide; ++i)
    for (std::size_t j = 0; j < kSide; ++j)
      for (std::size_t k = 0; k < kSide; ++k) {
        const Vec3 place{static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)};
        const Node node{i, j, k};
        EXPECT_NEAR(winding_number(mesh, place), values[node] < 0 ? 1 : 0, 1e-6);
      }
}

// Noise has cubes of all kinds: its surface is a manifold that parts inner and outer nodes, with the Euler number of their
// complex, and does not cross itself.
TEST(SignSurface, OfNoisePartsTheNodesAndDoesNotCrossItself) {
  std::mt19937 random(7);
  for (const double mean : {-0.6, 0.0, 0.6}) {
    std::normal_distribution<double> draw(mean, 1);
    expect_right(Values([&] { return draw(random); }));
  }
}

// Values of all nodes are one of a few, so that means of faces and cubes are often 0, and with 0 among them nodes lie on the
// zero set themselves.
TEST(SignSurface, OfLabelsPartsTheNodesAndDoesNotCrossItself) {
  std::mt19937 random(8);
  for (const double other : {-1.0, 0.0, 3.0})
    expect_right(Values([&] { return std::array{-1.0, 1.0, other}[random() % 3]; }));
}

// But for what vertices are kept away from nodes and faces.
TEST(SignSurface, LiesOnTheZeroSet) {
  const auto ball = [](const Vec3& p) { return norm(p - Vec3{5.1, 4.9, 5.3}) - 3.6; };
  const Mesh mesh = sign_surface(ball, {{1, 1, 1}, 0.5, {18, 18, 18}});
  expect_solid_boundary(mesh);
  for (const Vec3& p : mesh.points) EXPECT_NEAR(ball(p), 0, 1e-3);
  EXPECT_NEAR(mesh_facts(mesh).volume / (4.0 / 3 * M_PI * 3.6 * 3.6 * 3.6), 1, 0.005);
}

}  // namespace
}  // namespace affskel::core

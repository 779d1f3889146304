#include "core/spatial/oriented_box.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/split_mix64.h"
#include "core/spatial/oriented_box_tree.h"

namespace affskel::core {
namespace {

class DrawnTriangles {
 public:
  explicit DrawnTriangles(std::uint64_t seed) : random_(seed) {}
  Vec3 vector(double size = 0.25) {
    return size * Vec3{random_.symmetric(), random_.symmetric(), random_.symmetric()};
  }
  double share() { return 0.5 * (random_.symmetric() + 1); }
  std::uint64_t below(std::uint64_t bound) { return random_.next() % bound; }

  // From well shaped to a needle, a point in the end.
  Corners triangle() {
    const Vec3 p = vector(), along = vector(std::pow(10.0, -static_cast<double>(below(4))));
    return {p, p + along, p + share() * along + vector(std::pow(10.0, -static_cast<double>(below(20))))};
  }
  Vec3 point_in(const Corners& c) {
    const double u = share(), v = share() * (1 - u);
    return (1 - u - v) * c[0] + (u * c[1] + v * c[2]);
  }

 private:
  SplitMix64 random_;
};

void expect_orthonormal(const Matrix3& axes) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(dot(axes[i], axes[j]), i == j ? 1 : 0, 1e-14);
  }
}

TEST(OrientedBox, HoldsItsTriangleTightly) {
  DrawnTriangles draw(1);
  for (int n = 0; n < 2000; ++n) {
    const Corners c = draw.triangle();
    const OrientedBox box = oriented_box(c);
    expect_orthonormal(box.axes);
    for (const Vec3& p : c) {
      for (int k = 0; k < 3; ++k) {
        EXPECT_LE(std::abs(dot(box.axes[static_cast<std::size_t>(k)], p - box.centre)), box.half[k] + 1e-14);
      }
    }
    // Its sides: the longest one, the height over that, nothing.
    double longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, norm(c[(k + 1) % 3] - c[k]));
    EXPECT_NEAR(2 * box.half.x, longest, 1e-14);
    EXPECT_NEAR(2 * box.half.y * longest, norm(cross(c[1] - c[0], c[2] - c[0])), 1e-14 * longest);
    EXPECT_NEAR(box.half.z, 0, 1e-14);
  }
}

TEST(OrientedBox, OfTrianglesWithoutAreaIsSound) {
  const Vec3 p{0.25, -0.5, 0.125}, q{0.5, 0.25, 1};
  for (const Corners& c : {Corners{p, p, p}, Corners{p, q, p}, Corners{p, q, 0.5 * (p + q)}}) {
    const OrientedBox box = oriented_box(c);
    expect_orthonormal(box.axes);
    EXPECT_FALSE(surely_apart(box, c));
    EXPECT_NEAR(box.half.y + box.half.z, 0, 1e-15);
  }
}

TEST(OrientedBox, WhatHasAPointInCommonIsNeverApart) {
  DrawnTriangles draw(2);
  for (int n = 0; n < 20000; ++n) {
    const Corners c = draw.triangle();
    Corners d = draw.triangle();
    const Vec3 shift = draw.point_in(c) - (n % 2 == 0 ? d[0] : draw.point_in(d));
    for (Vec3& p : d) p = p + shift;
    const OrientedBox a = oriented_box(c), b = oriented_box(d);
    ASSERT_FALSE(surely_apart(a, b) || surely_apart(b, a)) << n;
    ASSERT_FALSE(surely_apart(a, d) || surely_apart(b, c)) << n;
  }
}

// Side by side, at an angle to all axes: boxes parallel to these would meet.
TEST(OrientedBox, SeparatesParallelSlivers) {
  const Vec3 along{0.5, 0.3, 0.4}, beside = 1e-6 * Vec3{0.3, -0.5, 0};
  const Vec3 o{}, far = 2.0 * beside;
  const Corners c = {o, along, beside}, d = {far, far + along, far + beside};
  const OrientedBox a = oriented_box(c), b = oriented_box(d);
  EXPECT_TRUE(surely_apart(a, b) && surely_apart(b, a));
  EXPECT_TRUE(surely_apart(a, d) && surely_apart(b, c));
}

TEST(OrientedBox, OfAPlainBoxHasItsPlace) {
  const OrientedBox box = oriented_box(Box{{-2, 0, 4}, {2, 2, 4}}, 0.125);
  EXPECT_EQ(box.axes, kIdentity3);
  EXPECT_EQ(box.centre, (Vec3{0, 0.125, 0.5}));
  EXPECT_EQ(box.half, (Vec3{0.25, 0.125, 0}));
}

TEST(UnitTriangles, AreAtMostOneAndExact) {
  for (const double size : {1.0, 3e-9, 0x1p1023, 1e-320}) {
    const Mesh mesh{{{size, 0, -size / 2}, {0, -size, 0}, {0, 0, 0}, {std::nan(""), 0, 0}}, {{0, 1, 2}}};
    const UnitTriangles triangles(mesh);
    const Corners c = triangles.corners(0);
    EXPECT_LE(c[0].x, 1);
    EXPECT_EQ(c[0].x / triangles.unit(), size);
    EXPECT_EQ(c[1].y, -c[0].x);
  }
}

// Triangle 300 + i has a point in common with triangle i.
Mesh pairs_that_meet() {
  DrawnTriangles draw(3);
  std::vector<Corners> corners;
  for (int n = 0; n < 300; ++n) corners.push_back(draw.triangle());
  for (std::size_t n = 0; n < 300; ++n) {
    Corners c = draw.triangle();
    const Vec3 shift = draw.point_in(corners[n]) - draw.point_in(c);
    for (Vec3& p : c) p = p + shift;
    corners.push_back(c);
  }
  Mesh mesh;
  for (const Corners& c : corners) {
    const auto first = static_cast<std::uint32_t>(mesh.points.size());
    mesh.points.insert(mesh.points.end(), c.begin(), c.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(OrientedBoxTree, FindsAllThatMeetAndFewOthers) {
  const Mesh mesh = pairs_that_meet();
  const UnitTriangles triangles(mesh);
  for (const std::uint32_t count : {0U, 1U, 4U, 5U, 300U}) {
    std::vector<std::uint32_t> members;
    for (std::uint32_t m = 0; m < count; ++m) members.push_back(2 * m + 1);
    const OrientedBoxTree tree(triangles, members), parallel(triangles, members, 3);
    std::size_t visited = 0;
    for (std::uint32_t i = 0; i < 600; ++i) {
      std::vector<std::uint32_t> found, same;
      const Corners corners = triangles.corners(i);
      const OrientedBox box = oriented_box(corners);
      tree.visit_above(i, corners, box, [&](std::uint32_t j) { found.push_back(j); });
      parallel.visit_above(i, corners, box, [&](std::uint32_t j) { same.push_back(j); });
      EXPECT_EQ(found, same);
      std::sort(found.begin(), found.end());
      EXPECT_EQ(std::adjacent_find(found.begin(), found.end()), found.end());
      for (const std::uint32_t j : found) {
        EXPECT_TRUE(j > i && std::binary_search(members.begin(), members.end(), j)) << i << " " << j;
      }
      const bool meets = i < 300 && std::binary_search(members.begin(), members.end(), 300 + i);
      EXPECT_TRUE(!meets || std::binary_search(found.begin(), found.end(), 300 + i)) << i;
      visited += found.size();
    }
    EXPECT_LE(visited, 10 * count);
  }
}

}  // namespace
}  // namespace affskel::core

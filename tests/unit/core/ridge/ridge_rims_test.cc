#include "core/ridge/ridge_rims.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/ridge/ridge_flaps.h"
#include "core/ridge/ridge_holes.h"
#include "core/ridge/ridge_meshes.h"

namespace affskel::core {
namespace {

double area(const SheetMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += triangle_area(mesh, t);
  return sum;
}

TEST(RidgeRims, AreLinesWhereTheStrengthMeetsTheLowerBound) {
  // s = 5 on the slanting line x = 10.3 + y / 3.
  SheetMesh mesh = square(20, [](double x, double y) { return 5 + 0.5 * (10.3 + y / 3 - x); });
  cut_rims(mesh, {5, 6});
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  std::size_t rim = 0;
  for (const SheetVertex& v : mesh.vertices) {
    EXPECT_LE(v.position.x, 10.3 + v.position.y / 3 + 1e-12);
    if (v.strength != 5) continue;
    ++rim;
    // A vertex on the rim is the mean of places on the line.
    EXPECT_NEAR(v.position.x, 10.3 + v.position.y / 3, 1e-12);
  }
  EXPECT_GE(rim, 21U);
  EXPECT_NEAR(area(mesh), 20 * 10.3 + 20 * 20 / 6.0, 4);
}

TEST(RidgeRims, KeepWhatIsConnectedWithSomethingStrong) {
  // Two hills on a plain of strength 1: only one reaches the higher bound.
  const auto hill = [](double x, double y, double cx, double top) {
    return top - 0.5 * std::hypot(x - cx, y - 10);
  };
  SheetMesh mesh = square(20, [&](double x, double y) {
    return std::max({1.0, hill(x, y, 5, 7), hill(x, y, 15, 5.9)});
  });
  const RidgePieces pieces = cut_rims(mesh, {5, 6});
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(pieces.shares.size(), 1U);
  EXPECT_EQ(pieces.bridges, 0U);
  EXPECT_DOUBLE_EQ(pieces.max_strength, 7);
  for (const SheetVertex& v : mesh.vertices) EXPECT_LE(std::hypot(v.position.x - 5, v.position.y - 10), 4.01);
  EXPECT_NEAR(area(mesh), 3.14159 * 16, 3);
}

TEST(RidgeRims, JoinsStrongPiecesThroughTheWeakSheet) {
  // The same with both strong, and a saddle of strength 4 at y = 10 between them.
  const auto strength = [](double x, double y) {
    const double hills = std::max(7 - 0.5 * std::hypot(x - 5, y - 10), 7 - 0.5 * std::hypot(x - 15, y - 10));
    return std::max({hills, 4 - std::abs(y - 10), 1.0});
  };
  SheetMesh mesh = square(20, strength);
  const RidgePieces pieces = cut_rims(mesh, {5, 6});
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(pieces.bridges, 1U);
  EXPECT_EQ(pieces.shares.size(), 1U);
  // Where nothing connects them, they stay two.
  SheetMesh apart = square(20, strength);
  std::erase_if(apart.triangles, [&](const Triangle& t) {
    return apart.vertices[t[0]].position.x == 10 || apart.vertices[t[1]].position.x == 10 ||
           apart.vertices[t[2]].position.x == 10;
  });
  EXPECT_EQ(cut_rims(apart, {5, 6}).shares.size(), 2U);
  EXPECT_EQ(topology(apart).betti, (BettiNumbers{2, 0, 0}));
}

TEST(RidgeRims, DropsWhatIsInsignificant) {
  const auto strength = [](double x, double y) {
    return std::max({1.0, 9 - 0.5 * std::hypot(x - 7, y - 10), 7 - std::hypot(x - 18, y - 10)});
  };
  // Apart from each other: areas of pi 64 (less the part beyond the square) and pi 4.
  const auto pieces = [&](double significance) {
    SheetMesh mesh = square(20, strength);
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
      return mesh.vertices[t[0]].position.x == 15 || mesh.vertices[t[1]].position.x == 15;
    });
    RidgeConstants constants;
    constants.significance = significance;
    return cut_rims(mesh, {5, 6}, constants).shares;
  };
  const std::vector<double> all = pieces(0);
  ASSERT_EQ(all.size(), 2U);
  EXPECT_NEAR(all[0] + all[1], 1, 1e-12);
  EXPECT_EQ(pieces(0.99 * all[1]).size(), 2U);
  EXPECT_EQ(pieces(1.01 * all[1]).size(), 1U);
}

TEST(RidgeRims, LeaveThePointOfARoundSolid) {
  SheetMesh mesh = square(20, [](double, double) { return 50; });
  for (SheetVertex& v : mesh.vertices) {
    v.roundness = 0.95;
    v.erosion = 100 - std::hypot(v.position.x - 12, v.position.y - 7);
  }
  cut_rims(mesh);
  EXPECT_EQ(mesh.triangles.size(), 6U);
  for (const SheetVertex& v : mesh.vertices) {
    EXPECT_LE(std::abs(v.position.x - 12), 1);
    EXPECT_LE(std::abs(v.position.y - 7), 1);
  }
}

TEST(RidgeRims, RefusesBoundsThatAreNone) {
  SheetMesh mesh = square(2, [](double, double) { return 9; });
  for (const RidgeBounds& bounds : {RidgeBounds{0, 6}, RidgeBounds{5, 4}})
    EXPECT_THROW(cut_rims(mesh, bounds), CoreError);
}

bool anywhere(const Vec3&) {
  return true;
}

// Without the triangles round the grid's vertices in a rectangle.
SheetMesh with_hole(double x0, double x1, double y0, double y1) {
  SheetMesh mesh = square(20, [](double, double) { return 9; });
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    for (const std::uint32_t c : t) {
      const Vec3& p = mesh.vertices[c].position;
      if (p.x >= x0 && p.x <= x1 && p.y >= y0 && p.y <= y1) return true;
    }
    return false;
  });
  drop_unused_vertices(mesh);
  return mesh;
}

TEST(RidgeHoles, AreClosedInTheSheet) {
  SheetMesh mesh = with_hole(6, 6, 8, 8);
  ASSERT_EQ(topology(mesh).betti, (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(close_holes(mesh, anywhere, {0.02}), 1U);
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(topology(mesh).boundary_loops, 1U);
  EXPECT_NEAR(area(mesh), 400, 1e-9);
}

TEST(RidgeHoles, ThatTouchAreClosedBoth) {
  SheetMesh mesh = with_hole(6, 6, 8, 8);
  // Both rims pass through (7, 9): one connected rim.
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    for (const std::uint32_t c : t)
      if (mesh.vertices[c].position == Vec3{8, 9, 0}) return true;
    return false;
  });
  drop_unused_vertices(mesh);
  ASSERT_LT(topology(mesh).boundary_loops, 3U);
  close_holes(mesh, anywhere, {0.05});
  EXPECT_EQ(topology(mesh).betti, (BettiNumbers{1, 0, 0}));
  EXPECT_NEAR(area(mesh), 400, 1e-9);
}

TEST(RidgeHoles, StayWhenLargeOrOutsideOfTheSolid) {
  SheetMesh large = with_hole(5, 12, 5, 12);
  EXPECT_EQ(close_holes(large, anywhere, {0.02}), 0U);
  EXPECT_EQ(topology(large).betti.holes, 1U);
  SheetMesh outside = with_hole(6, 6, 8, 8);
  EXPECT_EQ(close_holes(outside, [](const Vec3& u) { return norm(u - Vec3{6, 8, 0}) > 0.7; }, {0.02}), 0U);
}

// The square with a strip of `width` cells standing on its line y = 10, from x = 5 to x = 5 + length.
SheetMesh with_flap(std::uint32_t length, std::uint32_t width) {
  SheetMesh mesh = square(20, [](double, double) { return 9; });
  std::vector<std::uint32_t> below;
  for (std::uint32_t n = 0; n <= length; ++n) below.push_back(10 * 21 + 5 + n);
  for (std::uint32_t up = 1; up <= width; ++up) {
    std::vector<std::uint32_t> above;
    for (const std::uint32_t v : below) {
      SheetVertex vertex = mesh.vertices[v];
      vertex.position.z = up;
      above.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
      mesh.vertices.push_back(vertex);
      mesh.part.push_back(0);
    }
    for (std::size_t n = 0; n < length; ++n) {
      mesh.triangles.push_back({below[n], below[n + 1], above[n]});
      mesh.triangles.push_back({below[n + 1], above[n + 1], above[n]});
    }
    below = above;
  }
  return mesh;
}

TEST(RidgeFlaps, AreCutOffWhenSmall) {
  SheetMesh mesh = with_flap(3, 1);
  ASSERT_EQ(topology(mesh).branch_edges, 3U);
  EXPECT_EQ(cut_flaps(mesh, {0.01}), 1U);
  EXPECT_EQ(topology(mesh).branch_edges, 0U);
  EXPECT_NEAR(area(mesh), 400, 1e-9);
  EXPECT_EQ(mesh.vertices.size(), 441U);
  EXPECT_EQ(mesh.part.size(), 441U);
}

TEST(RidgeFlaps, StayWhenTheyAreBranches) {
  SheetMesh mesh = with_flap(10, 8);
  EXPECT_EQ(cut_flaps(mesh, {0.01}), 0U);
  EXPECT_EQ(topology(mesh).branch_edges, 10U);
  EXPECT_NEAR(area(mesh), 480, 1e-9);
}

}  // namespace
}  // namespace affskel::core

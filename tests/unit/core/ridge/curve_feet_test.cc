#include "core/ridge/curve_feet.h"

#include <gtest/gtest.h>

#include <random>

#include "core/ridge/ridge_meshes.h"

namespace affskel::core {
namespace {

SheetMesh scattered(std::size_t count, unsigned seed) {
  SheetMesh mesh;
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 30);
  for (std::size_t n = 0; n < count; ++n) {
    SheetVertex v;
    v.position = {any(random), any(random), any(random) - 15};
    mesh.vertices.push_back(v);
    mesh.part.push_back(n % 7 == 0 ? 1 : 0);
  }
  return mesh;
}

TEST(CurveFeet, StandOnTheNearestVertexOfTheirPart) {
  const SheetMesh mesh = scattered(500, 1);
  std::vector<RidgeCurve> curves{line(3, 20, 4), line(8, 25, 6)};
  for (SheetVertex& v : curves[1].vertices) v.position.z = v.position.x;  // aslant
  RidgeCurve other = line(5, 9, 40);
  other.part = 1;
  curves.push_back(other);
  const std::vector<CurveVertex> vertices = curve_vertices(curves);
  const std::vector<CurveFoot> feet = curve_feet(mesh, vertices, 1);
  for (std::size_t v = 0; v < feet.size(); ++v) {
    std::uint32_t nearest = kNoVertex;
    double away = 1e300;
    for (std::uint32_t c = 0; c < vertices.size(); ++c) {
      const double here = norm(vertices[c].position - mesh.vertices[v].position);
      if (vertices[c].part == mesh.part[v] && here < away) {
        nearest = c;
        away = here;
      }
    }
    const bool within = away <= vertices[nearest].radius;
    EXPECT_EQ(feet[v].vertex, within ? nearest : kNoVertex) << v;
    EXPECT_EQ(feet[v].place == CurveFoot::Place::kFar, !within) << v;
  }
}

TEST(CurveFeet, TellWhatLiesBeyondAnEnd) {
  SheetMesh mesh;
  const double x[] = {2, 4, 7, 15.5, 7};
  const double y[] = {15, 15, 18, 15, 20};
  for (int n = 0; n < 5; ++n) {
    SheetVertex v;
    v.position = {x[n], y[n], 0};
    mesh.vertices.push_back(v);
    mesh.part.push_back(0);
  }
  const std::vector<CurveVertex> curve = curve_vertices(std::vector{line(5, 15, 4)});
  const std::vector<CurveFoot> feet = curve_feet(mesh, curve, 1);
  using enum CurveFoot::Place;
  EXPECT_EQ(feet[0].place, kBeyondEnd);
  EXPECT_EQ(feet[1].place, kBeyondEnd);
  EXPECT_EQ(feet[2].place, kBeside);
  EXPECT_EQ(feet[3].place, kBeyondEnd);
  EXPECT_EQ(feet[4].place, kFar);
  EXPECT_TRUE(feet[4].sideways);
  EXPECT_EQ(curve_feet(mesh, curve, 2)[4].place, kBeside);
  // A closed curve has no ends.
  RidgeCurve ring = line(5, 15, 4);
  ring.closed = true;
  for (const CurveVertex& v : curve_vertices(std::vector{ring})) EXPECT_EQ(norm(v.outward), 0);
}

TEST(CurveFeet, TrianglesLieBesideOneCurve) {
  const SheetMesh strip = part_of_square(30, [](double, double y) { return y > 13 && y < 17; });
  const std::vector<CurveVertex> curves = curve_vertices(std::vector{line(3, 12, 4), line(18, 27, 4)});
  const std::vector<CurveFoot> feet = curve_feet(strip, curves, 1);
  for (const Triangle& t : strip.triangles) {
    bool left = true, right = true;
    for (const std::uint32_t corner : t) {
      const double x = strip.vertices[corner].position.x;
      left = left && x >= 3 && x <= 12;
      right = right && x >= 18 && x <= 27;
    }
    EXPECT_EQ(is_beside(feet, curves, t), left || right);
  }
}

}  // namespace
}  // namespace affskel::core

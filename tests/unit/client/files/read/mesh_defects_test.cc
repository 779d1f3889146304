#include "client/files/read/mesh_defects.h"

#include <gtest/gtest.h>

#include "core/shapes/shapes.h"

namespace affskel::client {
namespace {

// A tetrahedron as a file would give it: vertices on lines 3 .. 6, triangles on lines 7 .. 10.
core::OffMesh tetrahedron() {
  core::OffMesh off;
  off.mesh = core::make_tetrahedron(1);
  off.vertex_line = {3, 4, 5, 6};
  off.triangle_line = {7, 8, 9, 10};
  return off;
}

// The same with vertices of its own for each triangle.
core::OffMesh soup(core::OffMesh off) {
  core::Mesh apart;
  for (const core::Triangle& t : off.mesh.triangles) {
    const auto base = static_cast<std::uint32_t>(apart.points.size());
    for (const std::uint32_t corner : t) apart.points.push_back(off.mesh.points[corner]);
    apart.triangles.push_back({base, base + 1, base + 2});
  }
  off.mesh = apart;
  return off;
}

TEST(FindDefects, AClosedMeshHasNone) {
  EXPECT_TRUE(find_defects(tetrahedron()).empty());
}

TEST(FindDefects, VerticesAtOnePlaceCountAsOne) {
  EXPECT_TRUE(find_defects(soup(tetrahedron())).empty());
}

TEST(FindDefects, AHoleNamesItsEdgesAndLines) {
  core::OffMesh off = tetrahedron();
  off.mesh.triangles.pop_back();
  const std::vector<MeshDefect> defects = find_defects(off);
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_EQ(defects[0].code, "open-edges");
  EXPECT_EQ(defects[0].count, 3u);
  EXPECT_EQ(defects[0].name, "open edge");
  // The sides of the triangle that is gone.
  const core::Triangle gone = tetrahedron().mesh.triangles.back();
  for (const DefectPlace& place : defects[0].places) {
    EXPECT_GE(place.line, 7u);
    EXPECT_LE(place.line, 9u);
    ASSERT_EQ(place.edges.size(), 1u);
    for (const std::uint32_t v : {place.edges[0][0], place.edges[0][1]})
      EXPECT_NE(std::find(gone.begin(), gone.end(), v), gone.end());
  }
  EXPECT_TRUE(
      defect_text(defects[0]).starts_with("3 edges have a triangle on one side only (a hole): line "));
}

// As in files that give every triangle corners of its own.
TEST(FindDefects, AnEdgeHasTheVerticesOfItsTriangle) {
  core::OffMesh off = soup(tetrahedron());
  off.mesh.triangles.pop_back();
  const std::vector<MeshDefect> defects = find_defects(off);
  ASSERT_EQ(defects.size(), 1u);
  ASSERT_EQ(defects[0].count, 3u);
  for (const DefectPlace& place : defects[0].places) {
    const auto first = 3 * place.triangle, second = first + 1, third = first + 2;
    const auto vertices = [](std::uint32_t a, std::uint32_t b) {
      return ", vertices " + std::to_string(a) + " and " + std::to_string(b);
    };
    EXPECT_TRUE(place.detail == vertices(first, second) || place.detail == vertices(second, third) ||
                place.detail == vertices(first, third))
        << place_text(place);
  }
}

TEST(FindDefects, ARepeatedTriangleCrowdsItsEdges) {
  core::OffMesh off = tetrahedron();
  off.mesh.triangles.push_back(off.mesh.triangles[1]);
  off.triangle_line.push_back(11);
  const std::vector<MeshDefect> defects = find_defects(off);
  ASSERT_EQ(defects.size(), 2u);
  EXPECT_EQ(defects[0].code, "crowded-edges");
  EXPECT_EQ(defects[0].count, 3u);
  EXPECT_EQ(defects[1].code, "repeated-triangles");
  ASSERT_EQ(defects[1].places.size(), 1u);
  EXPECT_EQ(defects[1].places[0].line, 11u);
}

TEST(FindDefects, LongListsAreCut) {
  core::OffMesh off = tetrahedron();
  off.mesh.triangles.assign(9, {0, 0, 1});
  off.triangle_line.assign(9, 7);
  const std::vector<MeshDefect> defects = find_defects(off);
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_EQ(defects[0].code, "degenerate-triangles");
  EXPECT_EQ(defects[0].count, 9u);
  EXPECT_EQ(defects[0].places.size(), 5u);
  EXPECT_TRUE(defect_text(defects[0]).ends_with("; line 7, triangle 4; and 4 more"))
      << defect_text(defects[0]);
  const std::vector<MeshDefect> all = find_defects(off, 100);
  EXPECT_EQ(all[0].places.size(), 9u);
  EXPECT_TRUE(defect_text(all[0]).ends_with("; line 7, triangle 8")) << defect_text(all[0]);
}

}  // namespace
}  // namespace affskel::client

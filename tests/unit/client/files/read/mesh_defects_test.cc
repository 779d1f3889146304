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

TEST(FindDefects, AClosedMeshHasNone) {
  EXPECT_TRUE(find_defects(tetrahedron()).empty());
}

TEST(FindDefects, VerticesAtOnePlaceCountAsOne) {
  core::OffMesh off = tetrahedron();
  core::Mesh soup;
  for (const core::Triangle& t : off.mesh.triangles) {
    const auto base = static_cast<std::uint32_t>(soup.points.size());
    for (const std::uint32_t corner : t) soup.points.push_back(off.mesh.points[corner]);
    soup.triangles.push_back({base, base + 1, base + 2});
  }
  off.mesh = soup;
  EXPECT_TRUE(find_defects(off).empty());
}

TEST(FindDefects, AHoleNamesItsEdgesAndLines) {
  core::OffMesh off = tetrahedron();
  off.mesh.triangles.pop_back();
  const std::vector<MeshDefect> defects = find_defects(off);
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_EQ(defects[0].code, "open-edges");
  EXPECT_EQ(defects[0].count, 3u);
  for (const std::uint64_t line : defects[0].lines) {
    EXPECT_GE(line, 7u);
    EXPECT_LE(line, 9u);
  }
  EXPECT_NE(defects[0].message.find("line "), std::string::npos);
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
  EXPECT_EQ(defects[1].lines, std::vector<std::uint64_t>{11});
}

TEST(FindDefects, LongListsAreCut) {
  core::OffMesh off = tetrahedron();
  off.mesh.triangles.assign(9, {0, 0, 1});
  off.triangle_line.assign(9, 7);
  const std::vector<MeshDefect> defects = find_defects(off);
  ASSERT_EQ(defects.size(), 1u);
  EXPECT_EQ(defects[0].code, "degenerate-triangles");
  EXPECT_EQ(defects[0].count, 9u);
  EXPECT_EQ(defects[0].lines.size(), 5u);
  EXPECT_EQ(defects[0].message.substr(defects[0].message.size() - 3), "...");
}

}  // namespace
}  // namespace affskel::client

#include "client/exporters/mesh_writer.h"

#include <gtest/gtest.h>

#include <cstring>
#include <sstream>

#include "affskel/v1/types.pb.h"
#include "client/error.h"
#include "core/mesh_io.h"

namespace affskel::client {
namespace {

core::Mesh sample_mesh() {
  return {{{0.1, 0, 0}, {1, 0, 0}, {0, 1.0 / 3, 0}, {0, 0, 1e-300}}, {{0, 1, 2}, {2, 1, 3}}};
}

std::string written(FileFormat format, const core::Mesh& mesh,
                    const std::vector<std::string>& comments = {}) {
  std::string bytes;
  write_mesh(format, mesh, comments, [&](std::string_view piece) { bytes += piece; });
  return bytes;
}

TEST(MeshWriter, OffReadsBackExactly) {
  const core::Mesh mesh = sample_mesh();
  const core::OffMesh read = core::read_off(written(FileFormat::kOff, mesh));
  EXPECT_EQ(read.mesh.points, mesh.points);
  EXPECT_EQ(read.mesh.triangles, mesh.triangles);
}

TEST(MeshWriter, ObjReadsBackExactly) {
  const core::Mesh mesh = sample_mesh();
  std::istringstream in(written(FileFormat::kObj, mesh, {"job 7"}));
  std::string line;
  std::getline(in, line);
  EXPECT_EQ(line, "# job 7");
  core::Mesh read;
  for (std::string tag; in >> tag;) {
    if (tag == "v") {
      std::string x, y, z;
      in >> x >> y >> z;
      read.points.push_back({std::stod(x), std::stod(y), std::strtod(z.c_str(), nullptr)});
    } else {
      ASSERT_EQ(tag, "f");
      std::uint32_t a = 0, b = 0, c = 0;
      in >> a >> b >> c;
      read.triangles.push_back({a - 1, b - 1, c - 1});
    }
  }
  EXPECT_EQ(read.points, mesh.points);
  EXPECT_EQ(read.triangles, mesh.triangles);
}

TEST(MeshWriter, PlyHoldsTheMeshInBinary) {
  const core::Mesh mesh = sample_mesh();
  const std::string ply = written(FileFormat::kPly, mesh);
  const std::size_t body = ply.find("end_header\n") + 11;
  ASSERT_EQ(ply.size(), body + 4 * 24 + 2 * 13);
  for (std::size_t v = 0; v < 4; ++v) {
    double p[3];
    std::memcpy(p, ply.data() + body + 24 * v, sizeof p);
    EXPECT_EQ((core::Vec3{p[0], p[1], p[2]}), mesh.points[v]);
  }
  for (std::size_t t = 0; t < 2; ++t) {
    const char* row = ply.data() + body + 4 * 24 + 13 * t;
    EXPECT_EQ(row[0], 3);
    std::int32_t corners[3];
    std::memcpy(corners, row + 1, sizeof corners);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(std::uint32_t(corners[c]), mesh.triangles[t][c]);
  }
}

TEST(MeshWriter, StlHoldsNormalsAndCorners) {
  const std::string stl = written(FileFormat::kStl, sample_mesh());
  ASSERT_EQ(stl.size(), 84u + 2 * 50);
  EXPECT_NE(stl.substr(0, 5), "solid");
  std::uint32_t count = 0;
  std::memcpy(&count, stl.data() + 80, sizeof count);
  EXPECT_EQ(count, 2u);
  float first[12];
  std::memcpy(first, stl.data() + 84, sizeof first);
  EXPECT_EQ(first[0], 0.0f);
  EXPECT_EQ(first[1], 0.0f);
  EXPECT_EQ(first[2], 1.0f);  // the first triangle lies in z = 0, counter-clockwise
  EXPECT_EQ(first[3], 0.1f);
}

TEST(MeshWriter, AnEmptyMeshIsAValidFile) {
  EXPECT_EQ(written(FileFormat::kOff, {}).substr(0, 3), "OFF");
  EXPECT_EQ(written(FileFormat::kStl, {}).size(), 84u);
}

TEST(ParseSurface, RefusesCornersOutOfRange) {
  v1::TriangleMesh message;
  for (int i = 0; i < 9; ++i) message.add_xyz(i);
  for (const unsigned c : {0u, 1u, 2u}) message.add_corners(c);
  EXPECT_EQ(parse_surface(message.SerializeAsString()).mesh.triangles.size(), 1u);
  message.set_corners(2, 3);
  EXPECT_THROW(parse_surface(message.SerializeAsString()), ClientError);
}

}  // namespace
}  // namespace affskel::client

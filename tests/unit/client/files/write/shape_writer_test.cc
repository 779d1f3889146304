#include "client/files/write/shape_writer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <sstream>

#include "affskel/v1/types.pb.h"
#include "client/artifacts/surface.h"
#include "client/base/error.h"
#include "core/files/read/parse_shape.h"
#include "core/shapes/shapes.h"
#include "core/text/off_file.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

core::Mesh sample_mesh() {
  return {{{0.1, 0, 0}, {1, 0, 0}, {0, 1.0 / 3, 0}, {0, 0, 1e-300}}, {{0, 1, 2}, {2, 1, 3}}};
}

std::string written(FileFormat format, const core::Mesh& mesh,
                    const std::vector<std::string>& comments = {}) {
  std::string bytes;
  write_surface(format, shape_of(mesh), comments, [&](std::string_view piece) { bytes += piece; });
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

TEST(MeshWriter, CurvesReadBackWhereThereIsAPlaceForThem) {
  for (const bool with_triangles : {true, false}) {
    ShapeFile shape = shape_of(sample_mesh());
    if (!with_triangles) shape.off.mesh.triangles.clear();
    shape.segments = {{0, 1}, {1, 2}, {3, 1}};  // three lines meet in 1
    shape.columns = {{"E", false, {1, 2, 3, 4}}};
    for (const FileFormat format : surface_formats()) {
      std::string bytes;
      write_surface(format, shape, {"job 7"}, [&](std::string_view piece) { bytes += piece; });
      ShapeFile read = core::parse_shape(extension_of(format), bytes);
      EXPECT_EQ(read.mesh().triangles.size(), shape.mesh().triangles.size());
      if (!holds_curves(format)) {
        EXPECT_TRUE(read.segments.empty());
        continue;
      }
      EXPECT_TRUE(read.is_surface());
      EXPECT_EQ(read.mesh().points, shape.mesh().points);
      for (core::Segment& segment : read.segments) std::sort(segment.begin(), segment.end());
      EXPECT_EQ(read.segments, (std::vector<core::Segment>{{0, 1}, {1, 2}, {1, 3}})) << extension_of(format);
    }
  }
}

// As one object, Assimp and what reads by it (Open3D) would leave out the triangles, too.
TEST(MeshWriter, TrianglesAndCurvesAreObjectsOfTheirOwnInObj) {
  ShapeFile shape = shape_of(sample_mesh());
  const auto objects = [&shape] {
    std::string bytes;
    write_surface(FileFormat::kObj, shape, {}, [&](std::string_view piece) { bytes += piece; });
    std::istringstream rows(bytes);
    std::vector<std::string> kinds;  // of rows, one for neighbours of a kind
    for (std::string row; std::getline(rows, row);) {
      if (kinds.empty() || kinds.back() != row.substr(0, 1)) kinds.push_back(row.substr(0, 1));
    }
    return kinds;
  };
  EXPECT_EQ(objects(), (std::vector<std::string>{"v", "f"}));
  shape.segments = {{0, 1}};
  EXPECT_EQ(objects(), (std::vector<std::string>{"v", "o", "f", "o", "l"}));
}

TEST(MeshWriter, ACurveIsOneLine) {
  ShapeFile shape = shape_of(sample_mesh());
  shape.segments = {{0, 1}, {2, 1}, {2, 3}};
  const auto text = [&](FileFormat format) {
    std::string bytes;
    write_surface(format, shape, {}, [&](std::string_view piece) { bytes += piece; });
    return bytes;
  };
  EXPECT_NE(text(FileFormat::kObj).find("\nl 1 2 3 4\n"), std::string::npos);
  EXPECT_NE(text(FileFormat::kVtp).find("NumberOfLines=\"1\""), std::string::npos);
  const std::size_t triangles = shape.mesh().triangles.size();
  const std::string ply = text(FileFormat::kPly);
  EXPECT_NE(ply.find("\nelement face " + std::to_string(triangles + 3) + "\n"), std::string::npos);
  EXPECT_EQ(ply.find("element edge"), std::string::npos) << "at which meshio ends its program";
  shape.off.mesh.triangles.clear();
  EXPECT_NE(text(FileFormat::kPly).find("element edge 3\nproperty int vertex1\nproperty int vertex2\n"),
            std::string::npos);
}

TEST(MeshWriter, ACommentNeverHasASecondLine) {
  const std::vector<std::string> comments = {"of a\nv 9 9 9\telement\r"};
  EXPECT_EQ(written(FileFormat::kObj, sample_mesh(), comments).substr(0, 24), "# of a v 9 9 9 element?\n");
  EXPECT_NE(written(FileFormat::kPly, sample_mesh(), comments).find("\ncomment of a v 9 9 9 element?\n"),
            std::string::npos);
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

TEST(MeshWriter, StlSaysWhatItIsInItsHeader) {
  EXPECT_EQ(written(FileFormat::kStl, sample_mesh()).substr(0, 36), "triangle mesh, units as submitted   ");
  const std::string job(32, 'a'), hash(64, 'b');
  const std::vector<std::string> comments = {"content surface of body", "job " + job, "mesh_sha256 " + hash};
  EXPECT_EQ(written(FileFormat::kStl, sample_mesh(), comments).substr(0, 80),
            "job " + job + ", mesh " + std::string(16, 'b') + ", units as submitted" + " ");
}

TEST(MeshWriter, OffHasItsCommentsBehindItsFirstWord) {
  const std::string plain = written(FileFormat::kOff, sample_mesh());
  const std::string off = written(FileFormat::kOff, sample_mesh(), {"job 0", "a\nb"});
  EXPECT_EQ(off, "OFF\n# job 0\n# a b\n" + plain.substr(4));
  EXPECT_EQ(core::read_off(off).mesh.points, sample_mesh().points);
}

// The middle one of three triangles is thinner than single precision tells.
TEST(MeshWriter, StlHasNoTriangleOfTwoCorners) {
  core::Mesh mesh;
  mesh.points = {{0, 0, 0}, {1, 0, 0}, {1 + 1e-9, 0, 0}, {0, 1, 0}, {2, 1, 0}};
  mesh.triangles = {{0, 1, 3}, {1, 2, 3}, {2, 4, 3}};
  const std::string stl = written(FileFormat::kStl, mesh);
  ASSERT_EQ(stl.size(), 84u + 2 * 50);
  EXPECT_EQ(stl[80], 2);
}

// The exit code and the cause of writing as .stl, into a file.
std::string refusal_of_stl(const core::Mesh& mesh) {
  const tests::TemporaryDirectory dir;
  try {
    base::AtomicFile file(dir / "out.stl");
    write_into(file,
               [&](const WriteBytes& write) { write_surface(FileFormat::kStl, shape_of(mesh), {}, write); });
    file.commit();
  } catch (const ClientError& error) {
    EXPECT_EQ(error.exit_code(), ExitCode::kLimit);
    EXPECT_EQ(error.file(), dir / "out.stl");
    EXPECT_NE(std::string(error.what()).find(".off, .ply, .obj or .vtp"), std::string::npos) << error.what();
    return error.what();
  }
  return "";
}

core::Mesh moved(const core::Mesh& mesh, double factor, double shift) {
  core::Mesh result = mesh;
  for (core::Vec3& p : result.points) p = factor * p + core::Vec3{shift, shift, shift};
  return result;
}

TEST(MeshWriter, StlRefusesWhatSinglePrecisionSpoils) {
  const core::Mesh sphere = core::make_sphere(1, 320);
  EXPECT_EQ(refusal_of_stl(sphere), "");
  EXPECT_EQ(refusal_of_stl(moved(sphere, 1e38, 0)), "");
  EXPECT_EQ(refusal_of_stl(moved(sphere, 1e-30, 0)), "");
  EXPECT_EQ(refusal_of_stl(moved(sphere, 1, 1e4)), "");
  EXPECT_NE(refusal_of_stl(moved(sphere, 1e39, 0)).find("3.4e38"), std::string::npos);
  EXPECT_NE(refusal_of_stl(moved(sphere, 1e-46, 0)).find("320 of 320 triangles"), std::string::npos);
  EXPECT_NE(refusal_of_stl(moved(sphere, 1e-200, 0)).find("320 of 320 triangles"), std::string::npos);
  EXPECT_NE(refusal_of_stl(moved(sphere, 1, 1e8)).find("320 of 320 triangles"), std::string::npos);
  EXPECT_NE(refusal_of_stl(moved(sphere, 1, 1e8)).find("from (99999999"), std::string::npos);
  // A part too small for the place where it is, beside one that is not.
  core::Mesh two = moved(core::make_sphere(1, 1280), 1e6, 0);
  const auto first = static_cast<std::uint32_t>(two.points.size());
  const core::Mesh grain = moved(core::make_tetrahedron(1), 0.01, 1e7);
  two.points.insert(two.points.end(), grain.points.begin(), grain.points.end());
  for (const core::Triangle& t : grain.triangles) {
    two.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  EXPECT_NE(refusal_of_stl(two).find("4 of 1284 triangles"), std::string::npos);
  // A needle whose length leaves no digits for its width.
  EXPECT_NE(refusal_of_stl(moved(core::make_box(1e9, 1, 1), 1, 5e8)), "");
}

TEST(MeshWriter, StlHoldsSliversThatBecomeFlat) {
  // The surface of an eroded solid has a few: two vertices near one lattice point.  They share their edge
  // with others, which stay.
  core::Mesh mesh = core::make_sphere(1000, 1280);
  const core::Triangle t = mesh.triangles[0];
  const auto extra = static_cast<std::uint32_t>(mesh.points.size());
  mesh.points.push_back(mesh.points[t[0]] + 1e-9 * (mesh.points[t[1]] - mesh.points[t[0]]) +
                        1e-9 * (mesh.points[t[2]] - mesh.points[t[0]]));
  mesh.triangles[0] = {extra, t[1], t[2]};
  mesh.triangles.push_back({t[0], extra, t[2]});
  mesh.triangles.push_back({t[0], t[1], extra});
  EXPECT_EQ(refusal_of_stl(mesh), "");
}

TEST(MeshWriter, AnEmptyMeshIsAValidFile) {
  EXPECT_EQ(written(FileFormat::kOff, {}).substr(0, 3), "OFF");
  EXPECT_EQ(written(FileFormat::kStl, {}).size(), 84u);
}

TEST(ParseSurface, RefusesCornersOutOfRange) {
  v1::TriangleMesh message;
  for (int i = 0; i < 9; ++i) message.add_xyz(i);
  for (const unsigned c : {0u, 1u, 2u}) message.add_corners(c);
  EXPECT_EQ(parse_surface(message.SerializeAsString()).shape.mesh().triangles.size(), 1u);
  message.set_corners(2, 3);
  EXPECT_THROW(parse_surface(message.SerializeAsString()), ClientError);
}

}  // namespace
}  // namespace affskel::client

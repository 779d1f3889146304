#include "base/coding.h"
#include "client/files/read/read_shape.h"

#include <gtest/gtest.h>

#include <cstring>
#include <utility>

#include "client/artifacts/skeleton_points.h"
#include "client/base/error.h"
#include "client/files/write/shape_writer.h"
#include "core/files/numbers.h"
#include "core/shapes/shapes.h"
#include "core/solid/solid.h"
#include "core/text/off_file.h"
#include "sample_data.h"
#include "tools/files.h"
#include "tools/temporary_directory.h"

namespace affskel::client {
namespace {

class ShapeFileTest : public ::testing::Test {
 protected:
  ShapeFile read(const std::string& name, const std::string& bytes) {
    tests::write_file(dir_ / name, bytes);
    return read_shape(dir_ / name);
  }

  void expect_bad(const std::string& name, const std::string& bytes, std::uint64_t line,
                  const std::string& cause) {
    try {
      read(name, bytes);
      ADD_FAILURE() << name << " was read: " << bytes.substr(0, 100);
    } catch (const ClientError& error) {
      EXPECT_EQ(error.exit_code(), ExitCode::kBadInput) << error.what();
      EXPECT_EQ(error.file(), dir_ / name);
      EXPECT_EQ(error.line(), line) << error.what();
      EXPECT_NE(std::string(error.what()).find(cause), std::string::npos) << error.what();
    }
  }

  tests::TemporaryDirectory dir_;
};

TEST_F(ShapeFileTest, SkeletonsReadBackAsTheyWereWritten) {
  const v1::SkeletonPoints skeleton = sample_skeleton();
  for (const char* name : {"s.csv", "s.ply", "s.off", "s.xyz", "S.PLY", "s.vtp"}) {
    base::AtomicFile file(dir_ / name);
    const FileFormat format = choose_format(dir_ / name, skeleton_formats(), "skeleton");
    write_into(file, [&](const WriteBytes& write) {
      write_points(format, shape_of(skeleton), {"a comment"}, write);
    });
    file.commit();
    const ShapeFile shape = read_shape(dir_ / name);
    EXPECT_FALSE(shape.is_surface());
    ASSERT_EQ(shape.mesh().points.size(), static_cast<std::size_t>(skeleton.point_size())) << name;
    for (int i = 0; i < skeleton.point_size(); ++i) {
      const auto p = static_cast<std::size_t>(i);
      const core::Vec3 at = {skeleton.xyz(3 * i), skeleton.xyz(3 * i + 1), skeleton.xyz(3 * i + 2)};
      EXPECT_EQ(shape.mesh().points[p], at) << name;
      if (!holds_columns(format)) continue;
      EXPECT_EQ(shape.column("E")->values[p], skeleton.erosion(i));
      EXPECT_EQ(shape.column("ny")->values[p], skeleton.normal(3 * i + 1));
      EXPECT_EQ(shape.column("H")->values[p], skeleton.divergence(i));
      EXPECT_EQ(shape.column("direction")->values[p], skeleton.direction(i));
      EXPECT_TRUE(shape.column("direction")->whole);
    }
    EXPECT_EQ(shape.columns.size(), holds_columns(format) ? 6u : 0u) << name;
  }
}

TEST_F(ShapeFileTest, SurfacesReadBackAsTheyWereWritten) {
  const core::Mesh box = core::make_box(3, 2, 1);
  for (const FileFormat format : surface_formats()) {
    std::string bytes;
    write_surface(format, shape_of(box), {"comment"}, [&](std::string_view piece) { bytes += piece; });
    const ShapeFile shape = read("box" + std::string(extension_of(format)), bytes);
    EXPECT_TRUE(shape.is_surface());
    if (format == FileFormat::kStl) {  // its vertices come in the order of the triangles
      EXPECT_EQ(shape.mesh().points.size(), 8u);
      ASSERT_EQ(shape.mesh().triangles.size(), box.triangles.size());
      for (std::size_t t = 0; t < box.triangles.size(); ++t) {
        for (std::size_t c = 0; c < 3; ++c) {
          EXPECT_EQ(shape.mesh().points[shape.mesh().triangles[t][c]], box.points[box.triangles[t][c]]);
        }
      }
      continue;
    }
    EXPECT_EQ(shape.mesh().points, box.points) << extension_of(format);
    EXPECT_EQ(shape.mesh().triangles, box.triangles) << extension_of(format);
  }
}

TEST_F(ShapeFileTest, PlyComesInThreeEncodingsAndAnyTypes) {
  const std::string properties =
      "comment made by hand\nelement camera 1\nproperty float f\nelement vertex 4\nproperty float x\n"
      "property short flag\nproperty double y\nproperty float z\nelement face 1\n"
      "property list uchar uint vertex_index\nproperty uchar red\nend_header\n";
  const auto check = [](const ShapeFile& shape) {
    ASSERT_EQ(shape.mesh().points.size(), 4u);
    EXPECT_EQ(shape.mesh().points[2], (core::Vec3{1, 1.25, 0}));
    EXPECT_EQ(shape.mesh().triangles.size(), 2u);
    EXPECT_EQ(shape.off.polygons_cut, 1u);
    ASSERT_EQ(shape.columns.size(), 1u);
    EXPECT_EQ(shape.columns[0].name, "flag");
    EXPECT_TRUE(shape.columns[0].whole);
    EXPECT_EQ(shape.columns[0].values, (std::vector<double>{-1, 2, 3, 4}));
  };
  check(read("t.ply", "ply\r\nformat ascii 1.0\n" + properties +
                          "0.5\n0 -1 0 0\n1 2 0 0\n1 3 1.25 0\n0 4 1 0\n4 0 1 2 3 255\n"));
  for (const bool big : {false, true}) {
    std::string bytes;
    const auto add = [&](auto value) {
      std::string raw;
      base::append(raw, value);
      if (big) raw.assign(raw.rbegin(), raw.rend());
      bytes += raw;
    };
    add(0.5F);
    const double xy[4][2] = {{0, 0}, {1, 0}, {1, 1.25}, {0, 1}};
    for (int i = 0; i < 4; ++i) {
      add(static_cast<float>(xy[i][0]));
      add(static_cast<std::int16_t>(i == 0 ? -1 : i + 1));
      add(xy[i][1]);
      add(0.0F);
    }
    add(std::uint8_t{4});
    for (std::uint32_t i = 0; i < 4; ++i) add(i);
    add(std::uint8_t{255});
    const std::string format = big ? "binary_big_endian" : "binary_little_endian";
    check(read("b.ply", "ply\nformat " + format + " 1.0\n" + properties + bytes));
    expect_bad("b.ply", "ply\nformat " + format + " 1.0\n" + properties + bytes + "x", 0, "goes on");
    bytes.pop_back();
    expect_bad("b.ply", "ply\nformat " + format + " 1.0\n" + properties + bytes, 0, "ends inside face 0");
  }
}

TEST_F(ShapeFileTest, PlyErrorsNameThePlace) {
  const std::string head = "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n";
  expect_bad("a.ply", "", 1, "ply");
  expect_bad("a.ply", "ply\nelement vertex 1\nend_header\n", 3, "no format");
  expect_bad("a.ply", "ply\nformat ascii 1.0\n", 2, "end_header");
  expect_bad("a.ply", "ply\nformat ascii 2.0\nend_header\n", 2, "format");
  expect_bad("a.ply", "ply\nformat ascii 1.0\nelement vertex -1\nend_header\n", 3, "whole number");
  expect_bad("a.ply", "ply\nformat ascii 1.0\nend_header\n", 3, "no vertices");
  expect_bad("a.ply", head + "end_header\n1 2\n3 4\n", 6, "x, y and z");
  expect_bad("a.ply", head + "property quad z\nend_header\n", 6, "unknown type");
  const std::string good = head + "property float z\nend_header\n";
  expect_bad("a.ply", good + "1 2 3\n", 8, "ends before vertex 1");
  expect_bad("a.ply", good + "1 2 3\n4 5\n", 9, "too few");
  expect_bad("a.ply", good + "1 2 3\n4 5 6 7\n", 9, "too many");
  expect_bad("a.ply", good + "1 2 3\n4 nan 6\n", 9, "not finite");
  expect_bad("a.ply", good + "1 2 3\n4 y 6\n", 9, "not a number");
  expect_bad("a.ply", good + "1 2 3\n4 5 6\n7 8 9\n", 10, "goes on");
  expect_bad("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list uchar int vertex_indices\nend_header\ninf 0 1 2\n",
             10, "'inf' is outside the range of its type");
  expect_bad("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\n"
             "element face 1\nproperty list int int vertex_indices\nend_header\n-1 0 1 2\n",
             10, "a list of -1");
  expect_bad("a.ply",
             "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
             "property float y\nproperty float z\nend_header\n",
             7, "announced");
}

TEST_F(ShapeFileTest, PlyValuesFitTheirTypes) {
  const std::string head = "ply\nformat ascii 1.0\ncomment c\nelement vertex 3\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string end = "end_header\n";
  const auto with = [&](const std::string& type, const std::string& value) {
    return head + xyz + "property " + type + " a\n" + end + "0 0 0 0\n1 0 0 " + value + "\n0 1 0 0\n";
  };
  for (const auto& [type, value] : std::vector<std::pair<std::string, std::string>>{{"uchar", "300"},
                                                                                    {"uchar", "-1"},
                                                                                    {"char", "128"},
                                                                                    {"short", "-32769"},
                                                                                    {"ushort", "65536"},
                                                                                    {"int", "2147483648"},
                                                                                    {"uint32", "4294967296"},
                                                                                    {"uint", "inf"}}) {
    expect_bad("a.ply", with(type, value), 11, "outside the range of its type");
  }
  EXPECT_EQ(read("a.ply", with("uchar", "255")).columns[0].values[1], 255);
  EXPECT_EQ(read("a.ply", with("int", "-2147483648")).columns[0].values[1], -2147483648.0);
  expect_bad("a.ply", with("uint", "nan"), 11, "whole number");
  // Indices of vertices may be floats, but must be whole.
  const auto face = [&](const std::string& corners) {
    return head + xyz + "element face 1\nproperty list uchar float vertex_indices\n" + end +
           "0 0 0\n1 0 0\n0 1 0\n3 " + corners + "\n";
  };
  EXPECT_EQ(read("a.ply", face("0 1 2")).mesh().triangles.size(), 1u);
  expect_bad("a.ply", face("0 1 1.5"), 14, "1.5");
  expect_bad("a.ply", face("0 1 nan"), 14, "whole");
  expect_bad("a.ply", face("0 1 1e300"), 14, "whole");
  expect_bad("a.ply", face("0 1 -1"), 14, "does not exist");
}

TEST_F(ShapeFileTest, PlyHeadersSayEverythingOnce) {
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  expect_bad("a.ply", "ply\nformat ascii 1.0\nformat binary_little_endian 1.0\nend_header\n", 3, "second");
  expect_bad("a.ply", "ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "property int x\nend_header\n", 7,
             "called 'x'");
  expect_bad("a.ply",
             "ply\nformat ascii 1.0\nelement vertex 1\n" + xyz +
                 "property int E\nproperty float E\nend_header\n1 2 3 4 5\n",
             8, "called 'E'");
  expect_bad(
      "a.ply",
      "ply\nformat ascii 1.0\nelement vertex 0\n" + xyz + "element vertex 1\n" + xyz + "end_header\n1 2 3\n",
      11, "two elements");
}

TEST_F(ShapeFileTest, LinesInThePlyBodyAreThoseOfTheFile) {
  const std::string good =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\n1 2 3\n";
  expect_bad("a.ply", good + "4 5 \r6\n", 9, "carriage return");
  expect_bad("a.ply", good + "\n4 5 6" + std::string(1, '\0') + "\n", 10, "NUL");
  EXPECT_EQ(read("a.ply", good + "\n4 5 6\n").off.vertex_line, (std::vector<std::uint32_t>{8, 10}));
}

TEST_F(ShapeFileTest, StlTextKeepsItsOrder) {
  const std::string vertices = "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n";
  const std::string facet = "facet normal 0 0 1\nouter loop\n" + vertices + "endloop\nendfacet\n";
  EXPECT_EQ(read("t.stl", "solid a\n" + facet + "endsolid a\nsolid b\n" + facet + "endsolid b\n")
                .mesh()
                .triangles.size(),
            2u);
  expect_bad("t.stl", "solid\nfacet\nouter loop\n" + vertices + "endfacet\nendsolid\n", 7, "endloop");
  expect_bad("t.stl", "solid\nfacet\nouter loop\n" + vertices + "vertex 1 1 1\nendloop\nendfacet\n", 7,
             "after three vertices");
  expect_bad("t.stl", "solid\n" + vertices + "endsolid\n", 2, "expected facet");
  expect_bad("t.stl", "solid\n" + facet + "vertex 9 9 9\nendsolid\n", 9, "expected facet");
  expect_bad("t.stl", "solid\nfacet\n" + vertices + "endfacet\nendsolid\n", 3, "outer loop");
  expect_bad("t.stl", "solid\nfacet\nouter loop\n" + vertices + "endloop\nendsolid\n", 8, "endfacet");
  expect_bad("t.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\n", 4, "ends before a vertex");
  expect_bad("t.stl", "solid\n" + facet + "endsolid\n" + facet, 10, "expected solid");
}

TEST_F(ShapeFileTest, NamesOfColumnsThatWouldNotReadBackAreChanged) {
  const ShapeFile shape = read("c.csv", "x,y,z,my col,my_col,\"q\",my\tcol\n1,2,3,4,5,6,7\n");
  EXPECT_EQ(written_names(shape), (std::vector<std::string>{"my_col_2", "my_col", "_q_", "my_col_3"}));
  // A PLY name is any word.
  const ShapeFile ply = read("c.ply",
                             "ply\nformat ascii 1.0\nelement vertex 1\nproperty int x\nproperty int y\n"
                             "property int z\nproperty int a,b\nproperty int x#\nproperty int E\n"
                             "end_header\n1 2 3 4 5 6\n");
  EXPECT_EQ(written_names(ply), (std::vector<std::string>{"a_b", "x_", "E"}));
  for (const ShapeFile* from : {&shape, &ply}) {
    for (const FileFormat format : {FileFormat::kCsv, FileFormat::kPly, FileFormat::kVtp}) {
      std::string bytes;
      write_shape(format, *from, {}, [&](std::string_view piece) { bytes += piece; });
      const ShapeFile back = read("back" + std::string(extension_of(format)), bytes);
      ASSERT_EQ(back.columns.size(), from->columns.size());
      for (std::size_t c = 0; c < back.columns.size(); ++c) {
        EXPECT_EQ(back.columns[c].name, written_names(*from)[c]);
        EXPECT_EQ(back.columns[c].values, from->columns[c].values);
      }
    }
  }
}

TEST_F(ShapeFileTest, ColumnsOfWholeNumbersThatAreNotKeepTheirValues) {
  const ShapeFile csv = read("d.csv", "x,y,z,direction,H\n1,2,3,1.5,1\n4,5,6,nan,2\n");
  std::string bytes;
  write_shape(FileFormat::kPly, csv, {}, [&](std::string_view piece) { bytes += piece; });
  const ShapeFile ply = read("d.ply", bytes);
  EXPECT_EQ(ply.column("direction")->values[0], 1.5);
  EXPECT_NE(ply.column("direction")->values[1], ply.column("direction")->values[1]);
  EXPECT_EQ(ply.column("H")->values, (std::vector<double>{1, 2}));
}

TEST_F(ShapeFileTest, TablesOfNumbers) {
  const ShapeFile csv = read("t.csv", "\xEF\xBB\xBFname,z, x,y\r\n7,3,1,2\r\n\r\ninf,6,4,5\r\n");
  EXPECT_EQ(csv.mesh().points, (std::vector<core::Vec3>{{1, 2, 3}, {4, 5, 6}}));
  EXPECT_EQ(csv.columns[0].name, "name");
  const ShapeFile dat = read("t.dat", "1 2 3 0.5 0 0 1\n");
  EXPECT_EQ(dat.column("E")->values, (std::vector<double>{0.5}));
  EXPECT_EQ(dat.column("nz")->values, (std::vector<double>{1}));
  EXPECT_EQ(read("t.xyz", "# points\n1 2 3 1 0 0\n").column("nx")->values, (std::vector<double>{1}));
  expect_bad("t.csv", "", 1, "empty");
  expect_bad("t.csv", "1,2,3\n4,5,6\n", 1, "x, y and z");
  expect_bad("t.csv", "x,y,z\n1,2,3\n1,2\n", 3, "2 values");
  expect_bad("t.csv", "x,y,z\n1,2,\n", 2, "must be a number");
  expect_bad("t.csv", "x,y,z,E,E\n1,2,3,4,5\n", 1, "two columns");
  expect_bad("t.csv", "x,y,z\n1,2,nan\n", 2, "not finite");
  expect_bad("t.csv", "x,y,z,nx\n1,2,3,nan\n", 0, "point 0: nx");
  expect_bad("t.xyz", "1 2 3\n1 2 3 4 5 6\n", 2, "6 words");
  expect_bad("t.dat", "1 2 3\n", 1, "3 words");
}

TEST_F(ShapeFileTest, NormalsAloneMustBeFinite) {
  const auto file = [](const std::string& name) { return "x,y,z," + name + "\n1,2,3,4\n5,6,7,nan\n"; };
  for (const char* name : {"nx", "ny", "nz_a", "nx_b", "normal_x", "normals_y", "Normal_z", "Normals_x",
                           "Normals_a_y", "normal_b_z"}) {
    expect_bad("n.csv", file(name), 0, std::string("point 1: ") + name + " is not finite");
  }
  for (const char* name :
       {"noise_x", "n", "x_n", "nxt", "Nusselt_z", "normality_x", "normal_x_error", "normals", "density_y"}) {
    EXPECT_EQ(read("n.csv", file(name)).columns.size(), 1u) << name;
  }
}

TEST_F(ShapeFileTest, ObjAndStlText) {
  const ShapeFile obj =
      read("t.obj", "# c\nmtllib m\nv 0 0 0\nv 1 0 0 1.0\nv 1 1 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3 -1\n");
  EXPECT_EQ(obj.mesh().points.size(), 4u);
  EXPECT_EQ(obj.mesh().triangles.size(), 2u);
  ASSERT_EQ(obj.off.passed_over.size(), 2u);
  EXPECT_EQ(obj.off.passed_over[0].word, "mtllib");
  EXPECT_EQ(obj.off.passed_over[1].word, "vn");
  EXPECT_EQ(obj.off.passed_over[1].first_line, 7u);
  const ShapeFile continued =
      read("t.obj",
           "v 0 0 \\\n0\nv 1 0 \\\r\n0\nv 1 1 0\n\\\n\nv 0 1 0\nf 1 \\\n2 \\\n 3\nf 1 3 4\\\n\nv 5 5 5 \\");
  EXPECT_EQ(continued.mesh().points.size(), 5u) << "an empty line ends a statement, too";
  EXPECT_EQ(continued.mesh().triangles.size(), 2u);
  EXPECT_EQ(continued.off.triangle_line[0], 9u) << "where the statement begins";
  expect_bad("t.obj", "v 0 0 0\nf 1 2 3\n", 2, "vertex '2'");
  expect_bad("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 1\n", 4, "twice");
  expect_bad("t.obj", "v 0 0 0\nv 1 0 0\nf 1 2\n", 3, "needs 3");
  expect_bad("t.obj", "v 0 0 inf\n", 1, "not finite");
  const std::string facet =
      "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n";
  EXPECT_EQ(read("t.stl", "solid a name\n" + facet + facet + "endsolid\n").mesh().points.size(), 3u);
  expect_bad("t.stl", "solid\n" + facet, 8, "endsolid");
  expect_bad("t.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nendloop\n", 5, "1 vertices");
  expect_bad("t.stl", "rubbish", 0, "not an STL file");
}

TEST_F(ShapeFileTest, TheBeginningDecidesWhereTheExtensionDoesNot) {
  EXPECT_EQ(read("points", "OFF\n1 0 0\n1 2 3\n").mesh().points.size(), 1u);
  expect_bad("points.txt", "hello\n", 0, ".csv");
  EXPECT_THROW(read_shape(dir_ / "missing.ply"), ClientError);
}

TEST_F(ShapeFileTest, QuadrilateralsOverTheSameTwoEdgesHoldNoTriangleTwice) {
  // Both quadrilaterals have 1-3 for their shorter diagonal.
  const ShapeFile roof =
      read("roof.obj",
           "v -1 0 0\nv 0 -3 0\nv 1 0 0\nv 0 3 0\nv 0 0 0.5\nv 0 0 -2\nf 1 2 3 5\nf 1 5 3 4\n"
           "f 2 1 6\nf 3 2 6\nf 4 3 6\nf 1 4 6\n");
  EXPECT_DOUBLE_EQ(core::make_solid(roof.mesh()).volume, 4.5);
}

TEST_F(ShapeFileTest, WhatIsWrittenReadsBackWithItsColumns) {
  ShapeFile shape;
  shape.off.mesh = core::make_tetrahedron(1);
  shape.columns = {{"E", false, {1.0 / 3, 2, 3, 4}}, {"direction", true, {0, 1, 2, 4294967295.0}}};
  for (const bool surface : {true, false}) {
    if (!surface) shape.off.mesh.triangles.clear();
    for (const FileFormat format : shape_formats(shape)) {
      std::string bytes;
      write_shape(format, shape, {"a\nv 7 7 7"}, [&](std::string_view piece) { bytes += piece; });
      if (format == FileFormat::kStl) continue;  // single precision
      const ShapeFile back = read("t" + std::string(extension_of(format)), bytes);
      EXPECT_EQ(back.mesh().points, shape.mesh().points);
      EXPECT_EQ(back.mesh().triangles, shape.mesh().triangles);
      ASSERT_EQ(back.columns.size(), holds_columns(format) ? 2u : 0u);
      for (std::size_t c = 0; c < back.columns.size(); ++c) {
        EXPECT_EQ(back.columns[c].name, shape.columns[c].name);
        EXPECT_EQ(back.columns[c].values, shape.columns[c].values);
        EXPECT_EQ(back.columns[c].whole, shape.columns[c].whole);
      }
    }
  }
}

}  // namespace
}  // namespace affskel::client

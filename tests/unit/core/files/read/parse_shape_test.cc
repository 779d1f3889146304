#include "core/files/read/parse_shape.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/coding.h"
#include "core/base/error.h"
#include "core/files/read/shape_parsers.h"

namespace affskel::core {
namespace {

std::string binary_stl(std::string header) {
  header.resize(80, '\0');
  return header + std::string("\1\0\0\0", 4) + std::string(50, '\0');
}

std::string refusal(std::string_view extension, std::string_view bytes) {
  try {
    parse_mesh_file(extension, bytes);
  } catch (const CoreError& error) {
    return error.what();
  }
  return "";
}

constexpr std::string_view kTriangle = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

// Whatever the file is called.
TEST(ParseMeshFile, KindIsToldByTheContent) {
  const std::vector<std::pair<std::string, std::string>> kinds = {
      {"off", "OFF\n3 1 0\n" + std::string(kTriangle)},
      {"off", "\xEF\xBB\xBF# by hand\n\nCOFF 3 1\n0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n"},
      {"ply",
       "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
           std::string(kTriangle)},
      {"obj", "\xEF\xBB\xBF# by hand\n\n  v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"stl",
       "solid cube\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
       "endsolid\n"},
  };
  for (const auto& [kind, bytes] : kinds) {
    for (const char* extension : {".off", ".ply", ".obj", ".stl", ".vtp", ".glb", ".csv", ".txt", ""}) {
      const MeshFile file = parse_mesh_file(extension, bytes);
      EXPECT_EQ(file.format, kind) << extension;
      EXPECT_EQ(file.off_text, kind == "off") << extension;
      EXPECT_EQ(file.off.mesh.triangles.size(), 1U) << kind << extension;
    }
  }
}

// Such files are too large to be made here.
TEST(ParseShape, MoreThanCanBeNumberedIsRefused) {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 28;
  EXPECT_NO_THROW(check_counts(kMost, kMost));
  for (const auto& [points, triangles] : {std::pair(kMost + 1, kMost), std::pair(kMost, kMost + 1)}) {
    try {
      check_counts(points, triangles);
      ADD_FAILURE();
    } catch (const CoreError& error) {
      EXPECT_EQ(error.code(), CoreError::Code::kLimit);
    }
  }
}

// Behind what editors put first, and in capitals.
TEST(ParseMeshFile, AnStlOfTextMayBeginAsOtherTextDoes) {
  const std::string text =
      "solid cube\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1e0 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
      "endsolid\n";
  std::string capitals = text;
  for (char& c : capitals) c = c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  for (const std::string& bytes :
       {"\xEF\xBB\xBF" + text, "\n" + text, "  " + text, "# by hand\n" + text, capitals}) {
    for (const char* extension : {".stl", ".off"}) {
      const MeshFile file = parse_mesh_file(extension, bytes);
      EXPECT_EQ(file.format, "stl");
      EXPECT_EQ(file.off.mesh.triangles.size(), 1U);
    }
  }
}

TEST(ParseMeshFile, ABinaryStlsHeaderMayBeginWithAnything) {
  for (const char* header : {"", "solid cube", "ply", "OFF", "v", "<?xml", "glTF", "PK\3\4"}) {
    EXPECT_EQ(parse_mesh_file(".off", binary_stl(header)).format, "stl") << header;
  }
  EXPECT_THROW(parse_mesh_file(".off", binary_stl("ply") + "\n"), CoreError) << "too long for its count";
}

// A quadratic check of the names takes more than a minute for these.
TEST(ParseShape, ManyColumnsAreReadInTimeThatGrowsWithThem) {
  constexpr int kColumns = 200000;
  std::string
      csv = "x,y,z",
      ply = "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\n",
      values = "0,0,0", words = "0 0 0";
  for (int c = 0; c < kColumns; ++c) {
    const std::string name = "c" + std::to_string(c);
    csv += "," + name;
    ply += "property char " + name + "\n";
    values += ",0";
    words += " 0";
  }
  EXPECT_EQ(parse_shape(".csv", csv + "\n" + values + "\n").columns.size(), std::size_t{kColumns});
  EXPECT_EQ(parse_shape(".ply", ply + "end_header\n" + words + "\n").columns.size(), std::size_t{kColumns});
  EXPECT_NE(refusal(".csv", csv + ",c7\n").find("two columns are called 'c7'"), std::string::npos);
  EXPECT_NE(refusal(".ply", ply + "property char c7\nend_header\n").find("are called 'c7'"),
            std::string::npos);
}

TEST(ParseShape, JoinsCornersOfStlInTheirOrderBe0Negative) {
  const auto facet = [](const char* a, const char* b, const char* c) {
    std::string text = "facet normal 0 0 0\nouter loop\n";
    for (const char* corner : {a, b, c}) text += std::string("vertex ") + corner + "\n";
    return text + "endloop\nendfacet\n";
  };
  const Mesh mesh = parse_shape(".stl", "solid\n" + facet("0 0 0", "1 0 0", "0 1 0") +
                                            facet("0 1 -0", "1 -0 0", "-0 0 2") + "endsolid\n")
                        .mesh();
  ASSERT_EQ(mesh.points.size(), 4U);
  EXPECT_EQ(mesh.points[3].z, 2);
  EXPECT_EQ(mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}}));
}

TEST(ParseShape, RowsOfPlyMayEndWithCarriageReturnsAlone) {
  const std::string header =
      "ply\nformat FORMAT 1.0\ncomment by hand\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto file = [&](const std::string& format, const std::string& body, const std::string& end) {
    std::string bytes = header;
    bytes.replace(bytes.find("FORMAT"), 6, format);
    bytes += body;
    const std::size_t until = format == "ascii" ? bytes.size() : bytes.size() - body.size();
    std::string made;
    for (std::size_t i = 0; i < bytes.size(); ++i)
      made += bytes[i] == '\n' && i < until ? end : std::string(1, bytes[i]);
    return made;
  };
  std::string binary("\n\0\0\0", 4);  // a number that begins as a line ends
  for (const float x : {0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) base::append(binary, x);
  binary += '\3';
  for (const int corner : {0, 1, 2}) base::append(binary, corner);
  for (const char* end : {"\n", "\r\n", "\r"}) {
    EXPECT_EQ(parse_shape(".ply", file("ascii", std::string(kTriangle), end)).mesh().triangles.size(), 1U);
    EXPECT_EQ(parse_shape(".ply", file("binary_little_endian", binary, end)).mesh().triangles.size(), 1U);
  }
}

TEST(ParseShape, ElementsOfPlyThatArePassedOverAreTold) {
  const ShapeFile shape = parse_shape(
      ".ply",
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 1\nproperty list int int vertex_indices\nelement camera 0\nproperty float f\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  ASSERT_EQ(shape.off.passed_over.size(), 1U);
  EXPECT_EQ(shape.off.passed_over[0].word, "'tristrips'");
  EXPECT_EQ(shape.off.passed_over[0].rows, 1U);
  EXPECT_EQ(shape.off.passed_over[0].first_line, 15U);
}

// As some programs write creases.
TEST(ParseShape, EdgesOfPlyWithoutEndsArePassedOver) {
  const auto shape = [](const std::string& ends) {
    return parse_shape(
        ".ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nelement edge 1\n" +
            ends + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n0 1\n");
  };
  const ShapeFile creased = shape("property int v1\nproperty int v2\n");
  EXPECT_EQ(creased.mesh().triangles.size(), 1U);
  EXPECT_TRUE(creased.segments.empty());
  ASSERT_EQ(creased.off.passed_over.size(), 1U);
  EXPECT_EQ(creased.off.passed_over[0].word, "'edge'");
  EXPECT_EQ(shape("property int vertex1\nproperty int vertex2\n").segments.size(), 1U);
  EXPECT_THROW(shape("property int vertex1\nproperty int v2\n"), CoreError) << "one end";
}

// The last faces of a PLY file are curves where a comment says so, and where they look like them.
TEST(ParseShape, FacesOfTwoCornersAreCurvesWhereThatIsSaid) {
  const auto ply = [](const std::string& comment, const std::string& last) {
    return "ply\nformat ascii 1.0\n" + comment +
           "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
           "element face 3\nproperty list uchar int vertex_indices\nend_header\n"
           "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n3 0 1 1\n" +
           last + "\n";
  };
  const auto counts = [&](const std::string& comment, const std::string& last) {
    const ShapeFile shape = parse_shape(".ply", ply(comment, last));
    return std::pair(shape.mesh().triangles.size(), shape.segments.size());
  };
  EXPECT_EQ(counts("", "3 1 2 2"), std::pair(3ul, 0ul));
  EXPECT_EQ(counts("comment curves of mine\n", "3 1 2 2"), std::pair(3ul, 0ul));
  EXPECT_EQ(counts("comment curves 1\n", "3 1 2 2"), std::pair(2ul, 1ul));
  EXPECT_EQ(counts("comment curves 2 (the last faces)\n", "3 1 2 2"), std::pair(1ul, 2ul));
  EXPECT_EQ(counts("comment curves 2\n", "3 2 1 0"), std::pair(2ul, 1ul));
  EXPECT_EQ(counts("comment curves 99999999999999999999\n", "3 1 2 2"), std::pair(3ul, 0ul));
  EXPECT_EQ(counts("comment curves 99\n", "3 1 2 2"), std::pair(1ul, 2ul));
}

// By what they begin with, whatever they are called.
TEST(ParseMeshFile, SaysWhatAnotherKindIsAndWhatToDo) {
  using namespace std::string_literals;
  for (const char* extension : {".off", ".stl", ".glb", ""}) {
    EXPECT_NE(refusal(extension, "glTF\1\0\0\0"s).find("no binary glTF of version 2; export"),
              std::string::npos);
    EXPECT_NE(refusal(extension,
                      "\xfd"
                      "7zXZ\0\0"s)
                  .find("unxz"),
              std::string::npos);
    EXPECT_NE(refusal(extension, "PK\x03\x04").find("cut off or changed on its way"), std::string::npos);
    EXPECT_NE(refusal(extension, "ISO-10303-21;\nHEADER;").find("STEP"), std::string::npos);
  }
  for (const char* extension : {".stl", ".ply", ".obj", ".glb", ".3mf", ".vtp", ".nrrd"})
    EXPECT_NE(refusal(extension, "").find("the file is empty"), std::string::npos) << extension;
  EXPECT_NE(refusal(".amf", "<?xml version=\"1.0\"?>\n<amf/>").find("is XML of the kind 'amf'"),
            std::string::npos);
  // The header of a binary STL may say anything.
  EXPECT_EQ(refusal(".stl", binary_stl("glTF")).find("glTF"), std::string::npos);
}

}  // namespace
}  // namespace affskel::core

#include "core/files/read/parse_shape.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <utility>

#include "core/base/error.h"

namespace affskel::core {
namespace {

std::string binary_stl(std::string header) {
  header.resize(80, '\0');
  return header + std::string("\1\0\0\0", 4) + std::string(50, '\0');
}

TEST(ExtensionOfContent, IsToldByTheFirstWord) {
  EXPECT_EQ(extension_of_content("ply\nformat ascii 1.0\n"), ".ply");
  EXPECT_EQ(extension_of_content("solid cube\n"), ".stl");
  EXPECT_EQ(extension_of_content("<?xml version=\"1.0\"?>\n<VTKFile>"), ".vtp");
  EXPECT_EQ(extension_of_content("\xEF\xBB\xBF# by hand\n\n  v 0 0 0\n"), ".obj");
  EXPECT_EQ(extension_of_content("OFF\n3 1 0\n"), ".off");
  EXPECT_EQ(extension_of_content(""), ".off");
}

TEST(ExtensionOfContent, ABinaryStlsHeaderMayBeginWithAnything) {
  for (const char* header : {"", "solid cube", "ply", "OFF", "v", "<?xml"}) {
    EXPECT_EQ(extension_of_content(binary_stl(header)), ".stl") << header;
  }
  EXPECT_EQ(extension_of_content(binary_stl("ply") + "\n"), ".ply") << "too long for its count";
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

std::string refusal(std::string_view extension, std::string_view bytes) {
  try {
    parse_mesh_file(extension, bytes);
  } catch (const CoreError& error) {
    return error.what();
  }
  return "";
}

// By what they begin with, whatever they are called.
TEST(ParseMeshFile, SaysWhatAnotherKindIsAndWhatToDo) {
  using namespace std::string_literals;
  for (const char* extension : {".off", ".stl", ".glb", ""}) {
    EXPECT_NE(refusal(extension, "glTF\2\0\0\0"s).find("binary glTF (.glb), and not read; export"),
              std::string::npos);
    EXPECT_NE(refusal(extension, "\x1f\x8b\x08\0\0"s).find("compressed by gzip"), std::string::npos);
    EXPECT_NE(refusal(extension,
                      "\xfd"
                      "7zXZ\0\0"s)
                  .find("unxz"),
              std::string::npos);
    EXPECT_NE(refusal(extension, "PK\x03\x04").find("archive"), std::string::npos);
    EXPECT_NE(refusal(extension, "ISO-10303-21;\nHEADER;").find("STEP"), std::string::npos);
  }
  // The header of a binary STL may say anything.
  EXPECT_EQ(refusal(".stl", binary_stl("glTF")).find("glTF"), std::string::npos);
}

}  // namespace
}  // namespace affskel::core

#include "core/files/read/parse_shape.h"

#include <gtest/gtest.h>

#include <string>

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

}  // namespace
}  // namespace affskel::core

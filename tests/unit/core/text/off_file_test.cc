#include "core/text/off_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "core/base/error.h"
#include "core/shapes/shapes.h"
#include "core/stopping_context.h"

namespace affskel::core {
namespace {

const std::string kVertices = "0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string kFaces = "3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n";
const std::string kTetrahedron = "OFF\n4 4 6\n" + kVertices + kFaces;

// The line that the reader complains about, 0 when it does not.
std::uint64_t line_refused(const std::string& text) {
  try {
    read_off(text);
    return 0;
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kBadInput);
    EXPECT_NE(std::string(error.what()).find("line " + std::to_string(error.line())), std::string::npos);
    return error.line();
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

void expect_tetrahedron(const std::string& text) {
  const OffMesh off = read_off(text);
  ASSERT_EQ(off.mesh.points.size(), 4U);
  ASSERT_EQ(off.mesh.triangles.size(), 4U);
  EXPECT_EQ(off.mesh.points[1], (Vec3{1, 0, 0}));
  EXPECT_EQ(off.mesh.triangles[2], (Triangle{1, 2, 3}));
}

TEST(ReadOff, AcceptsTheFormsThatGeomviewWrites) {
  expect_tetrahedron(kTetrahedron);
  expect_tetrahedron("OFF 4 4 6\n" + kVertices + kFaces);
  expect_tetrahedron("OFF # a comment\n\n# another\n4 4\n" + kVertices + "\n" + kFaces + "\n# the end\n\n");
  expect_tetrahedron("OFF\n4 4 6\n0 0 0\n+1.0e0 0 -0\n0 1E+0 0 # here\n0 0 1\n" + kFaces);
}

TEST(ReadOff, AcceptsCarriageReturnsBeforeLineFeeds) {
  std::string text;
  for (char c : kTetrahedron) text += c == '\n' ? "\r\n" : std::string(1, c);
  expect_tetrahedron(text);
}

TEST(ReadOff, AcceptsCarriageReturnsAlone) {
  std::string text = kTetrahedron;
  std::replace(text.begin(), text.end(), '\n', '\r');
  expect_tetrahedron(text);
}

TEST(ReadOff, PassesOverAByteOrderMarkAtTheStartAlone) {
  expect_tetrahedron("\xEF\xBB\xBF" + kTetrahedron);
  EXPECT_EQ(line_refused("\n\xEF\xBB\xBF" + kTetrahedron), 2U);
}

TEST(ReadOff, SkipsTheAttributesThatTheHeaderPromises) {
  const auto with = [](const std::string& header, const std::string& extra) {
    return header + "\n4 4 6\n0 0 0" + extra + "\n1 0 0" + extra + "\n0 1 0" + extra + "\n0 0 1" + extra +
           "\n" + kFaces;
  };
  expect_tetrahedron(with("COFF", " 10 20 30 255"));
  expect_tetrahedron(with("COFF", " 0.1 0.2 0.3"));
  expect_tetrahedron(with("NOFF", " 0 0 1"));
  expect_tetrahedron(with("STOFF", " 0.5 0.5"));
  expect_tetrahedron(with("STCNOFF", " 0 0 1 10 20 30 255 0.5 0.5"));
  expect_tetrahedron("4OFF\n4 4 6\n0 0 0 2\n2 0 0 2\n0 -3 0 -3\n0 0 1 1\n" + kFaces);
  EXPECT_EQ(line_refused("4OFF\n4 4 6\n0 0 0 2\n2 0 0 0\n0 -3 0 -3\n0 0 1 1\n" + kFaces), 4U);
  EXPECT_EQ(line_refused(with("CNOFF", "")), 3U);
}

// As several viewers write them.
TEST(ReadOff, SkipsColoursThatTheHeaderDoesNotPromise) {
  const auto with = [](const std::string& first, const std::string& others) {
    return "OFF\n4 4 6\n0 0 0" + first + "\n1 0 0" + others + "\n0 1 0" + others + "\n0 0 1" + others + "\n" +
           kFaces;
  };
  for (const char* extra : {" 10 20 30 255", " 0.1 0.2 0.3"}) {
    expect_tetrahedron(with(extra, extra));
    const OffMesh off = read_off(with(extra, extra));
    ASSERT_EQ(off.passed_over.size(), 1U);
    EXPECT_EQ(off.passed_over[0].rows, 4U);
    EXPECT_EQ(off.passed_over[0].first_line, 3U);
  }
  EXPECT_EQ(line_refused(with(" 1 1 1", " 1 1 1 1")), 4U);
  EXPECT_EQ(line_refused(with("", " 1 1 1")), 4U);
  EXPECT_EQ(line_refused(with(" 1 1", " 1 1")), 3U);
}

TEST(ReadOff, SkipsFaceColours) {
  expect_tetrahedron("OFF\n4 4 6\n" + kVertices +
                     "3 0 2 1 7\n3 0 1 3 255 0 0\n3 1 2 3 0.1 0.2 0.3 1\n3 0 3 2\n");
  EXPECT_EQ(line_refused("OFF\n4 4 6\n" + kVertices + "3 0 2 1 7 8\n3 0 1 3\n3 1 2 3\n3 0 3 2\n"), 7U);
}

TEST(ReadOff, CutsPolygonsIntoTrianglesThatKeepTheLine) {
  const OffMesh off = read_off("OFF\n5 2 0\n0 0 0\n3 0 0\n3 1 0\n0 1 0\n1 5 0\n4 0 1 2 3\n3 0 1 4\n");
  ASSERT_EQ(off.mesh.triangles.size(), 3U);
  EXPECT_EQ(off.triangle_line, (std::vector<std::uint32_t>{8, 8, 9}));
  EXPECT_EQ(off.vertex_line, (std::vector<std::uint32_t>{3, 4, 5, 6, 7}));
  EXPECT_EQ(off.polygons_cut, 1U);
}

TEST(ReadOff, NamesTheLineOfWhatIsWrong) {
  EXPECT_EQ(line_refused(""), 1U);
  EXPECT_EQ(line_refused("ply\n"), 1U);
  EXPECT_EQ(line_refused("OFF BINARY\n"), 1U);
  EXPECT_EQ(line_refused("nOFF\n3\n4 4 6\n"), 1U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "4 4 6", "4")), 2U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "4 4 6", "-4 4 6")), 2U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "1 0 0", "1,5 0 0")), 4U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "1 0 0", "nan 0 0")), 4U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "1 0 0", "inf 0 0")), 4U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "1 0 0", "1e999 0 0")), 4U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "1 0 0", "0x1 0 0")), 4U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "1 0 0", "1 0")), 4U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "1 0 0", std::string("1 0\0 0", 6))), 4U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "3 0 1 3", "3 0 1 4")), 8U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "3 0 1 3", "3 0 1 -1")), 8U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "3 0 1 3", "3 0 1 0.5")), 8U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "3 0 1 3", "4 0 1 3 1")), 8U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "3 0 1 3", "2 0 1")), 8U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "3 0 1 3", "4 0 1 3")), 8U);
  EXPECT_EQ(line_refused(kTetrahedron + "3 0 1 2\n"), 11U);
  std::string macintosh = replaced(kTetrahedron, "1 0 0", "1 0");
  std::replace(macintosh.begin(), macintosh.end(), '\n', '\r');
  EXPECT_EQ(line_refused(macintosh), 4U);
  EXPECT_EQ(line_refused(replaced(kTetrahedron, "1 0 0", "1 0\r0")), 4U) << "line ends of two kinds";
}

TEST(ReadOff, SaysHowManyFacesThereAre) {
  try {
    read_off(kTetrahedron + "3 0 1 2\n3 0 2 3\n");
    ADD_FAILURE();
  } catch (const CoreError& error) {
    EXPECT_NE(std::string(error.what()).find("announce 6 in line 2"), std::string::npos) << error.what();
  }
}

TEST(ReadOff, TakesTrianglesWithoutArea) {
  const OffMesh off = read_off(replaced(kTetrahedron, "3 0 1 3", "3 0 1 1"));
  EXPECT_EQ(off.mesh.triangles.size(), 4U);
  EXPECT_EQ(std::count(off.mesh.triangles.begin(), off.mesh.triangles.end(), Triangle{0, 1, 1}), 1);
}

TEST(ReadOff, SaysWhereATruncatedFileEnds) {
  for (std::size_t length = 0; length + 2 < kTetrahedron.size(); ++length) {
    EXPECT_NE(line_refused(kTetrahedron.substr(0, length)), 0U) << length << " bytes";
  }
}

TEST(ReadOff, RefusesCountsThatCannotBeBeforeAllocating) {
  EXPECT_EQ(line_refused("OFF\n200000000 4 6\n" + kVertices + kFaces), 2U);
  try {
    read_off("OFF\n353535235358 1 0\n0 0 0\n");
    FAIL();
  } catch (const CoreError& error) {
    EXPECT_EQ(error.code(), CoreError::Code::kLimit);
  }
}

TEST(WriteOff, ReadsBackTheSameBits) {
  Mesh mesh = make_sphere(1.0 / 3, 80);
  mesh.points[0].x = 1e-300;
  mesh.points[1].y = -1.7976931348623157e308;
  const OffMesh off = read_off(write_off(mesh));
  EXPECT_EQ(off.mesh.points, mesh.points);
  EXPECT_EQ(off.mesh.triangles, mesh.triangles);
}

TEST(ReadOff, StopsWhereverItIsAsked) {
  const std::string text = write_off(make_sphere(1, 5120));
  expect_stops_wherever_it_is_asked(5, [&](ExecutionContext* context) { read_off(text, context); });
}

}  // namespace
}  // namespace affskel::core

#include "client/files/write/curve_graph.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

#include "client/base/error.h"
#include "client/files/write/shape_writer.h"

namespace affskel::client {
namespace {

// What GraphML tells by a key, in the order of the file.
std::vector<int> told(const std::string& xml, const std::string& key) {
  std::vector<int> values;
  const std::string begin = "<data key=\"" + key + "\">";
  for (std::size_t at = 0; (at = xml.find(begin, at)) != std::string::npos; ++at)
    values.push_back(std::stoi(xml.substr(at + begin.size())));
  return values;
}

// A fork of three lines, a loop by itself, and a place without a line.
ShapeFile fork_and_loop() {
  ShapeFile shape;
  shape.off.mesh.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 4, 0}, {2, -2, 0},
                           {9, 0, 0}, {9, 1, 0}, {9, 0, 1}, {5, 5, 5}};
  shape.segments = {{0, 1}, {1, 2}, {2, 3}, {2, 4}, {5, 6}, {6, 7}, {7, 5}};
  shape.columns = {{"E", false, {1, 2, 9, 3, 4, 5, 6, 7, 8}},
                   {"radius", false, {1, 2, 3, 1, 1, 1, 1, 1, 1}},
                   {"distance", false, std::vector<double>(9, 0.5)},
                   {"share", false, {0.1, 0.4, 0, 0.1, 0.1, 0.1, 0.1, 0.05, 0.05}}};
  return shape;
}

std::string written(FileFormat format) {
  std::string text;
  write_curve(format, fork_and_loop(), {"made by <hand> & \"eye\""},
              [&](std::string_view bytes) { text += bytes; });
  return text;
}

// See core's curve_graph; a place without a line is no branch of a file.
TEST(CurveGraph, HasLinesAsBranchesAndLonePlacesAsNodes) {
  const core::CurveGraph graph = curve_graph(fork_and_loop());
  EXPECT_EQ(graph.nodes, (std::vector<std::uint32_t>{0, 2, 3, 4, 5, 8}));
  EXPECT_EQ(graph.degree, (std::vector<std::uint32_t>{1, 3, 1, 1, 2, 0}));
  ASSERT_EQ(graph.branches.size(), 5U);
  EXPECT_EQ(graph.branches[4].kind, core::BranchKind::kPoint);
  const core::CurveBranch& first = graph.branches[0];
  EXPECT_EQ(first.vertices, (std::vector<std::uint32_t>{2, 1, 0}));
  EXPECT_EQ(first.length, 2);
  EXPECT_NEAR(first.mean_radius, 5. / 3, 1e-12) << "of lengths 2 and 1, without the joint";
  EXPECT_NEAR(first.share, 0.5, 1e-12);
  double sum = 0;
  for (const core::CurveBranch& branch : graph.branches) sum += branch.share;
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(CurveGraph, NeedsWhatItTells) {
  ShapeFile shape = fork_and_loop();
  shape.columns.pop_back();
  EXPECT_THROW(curve_graph(shape), ClientError);
}

TEST(CurveGraph, IsJson) {
  const auto file = nlohmann::json::parse(written(FileFormat::kJson));
  EXPECT_EQ(file["about"][0], "made by <hand> & \"eye\"");
  ASSERT_EQ(file["nodes"].size(), 6U);
  EXPECT_EQ(file["nodes"][2]["place"], nlohmann::json({3, 4, 0}));
  EXPECT_EQ(file["nodes"][2]["E"], 3);
  ASSERT_EQ(file["branches"].size(), 4U);
  EXPECT_EQ(file["branches"][0]["part"], 1);
  EXPECT_EQ(file["branches"][0]["nodes"], nlohmann::json({1, 0}));
  EXPECT_EQ(file["branches"][0]["vertices"].size(), 3U);
}

// A body that limbs hang on is a part, and no line: the others keep their numbers.
TEST(CurveGraph, OfABodyWithLimbsHasTheirNumbersAsParts) {
  ShapeFile shape = fork_and_loop();
  shape.columns.back().values = {0.1, 0.1, 0.5, 0.1, 0.05, 0.05, 0.05, 0.02, 0.03};
  std::string text;
  write_curve(FileFormat::kJson, shape, {}, [&](std::string_view bytes) { text += bytes; });
  const auto file = nlohmann::json::parse(text);
  ASSERT_EQ(file["branches"].size(), 4U);
  EXPECT_EQ(file["branches"][0]["part"], 2);
  EXPECT_EQ(file["nodes"][1]["part"], 1);
  EXPECT_EQ(file["nodes"][1]["volume_share"], 0.5);
  EXPECT_FALSE(file["nodes"][0].contains("part"));
  double sum = 0;
  for (const char* list : {"nodes", "branches"})
    for (const auto& one : file[list]) sum += one.value("volume_share", 0.0);
  EXPECT_NEAR(sum, 1, 1e-12) << "with the place that has no line";
  EXPECT_EQ(file["branches"][0]["length_in_bodies"], 1);
  EXPECT_EQ(file["branches"][0]["length"], 1);
  std::string xml;
  write_curve(FileFormat::kGraphMl, shape, {}, [&](std::string_view bytes) { xml += bytes; });
  EXPECT_NE(xml.find("<data key=\"node_volume_share\">0.5</data>"), std::string::npos) << xml;
  const auto of_json = [&](const char* list, const char* name) {
    std::vector<int> values;
    for (const auto& one : file[list])
      if (one.contains(name) && !one[name].is_null()) values.push_back(one[name]);
    return values;
  };
  EXPECT_EQ(told(xml, "node_degree"), of_json("nodes", "degree"));
  EXPECT_EQ(told(xml, "node_part"), of_json("nodes", "part"));
  EXPECT_EQ(told(xml, "edge_part"), of_json("branches", "part"));
  EXPECT_EQ(told(xml, "node_degree"), (std::vector<int>{1, 3, 1, 1, 2, 0}))
      << "ends, the joint, the loop, a place";
  EXPECT_NE(xml.find("<data key=\"edge_length_in_bodies\">1</data>"), std::string::npos) << xml;
}

TEST(CurveGraph, IsGraphMl) {
  const std::string text = written(FileFormat::kGraphMl);
  EXPECT_NE(text.find("made by &lt;hand&gt; &amp; \"eye\""), std::string::npos);
  EXPECT_NE(text.find("<edge id=\"b0\" source=\"n1\" target=\"n0\">"), std::string::npos);
  EXPECT_NE(text.find("<data key=\"edge_polyline\">2 0 0; 1 0 0; 0 0 0</data>"), std::string::npos);
  // Every key that is used is told of.
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find("<data key=\"");
    if (at == std::string::npos) continue;
    const std::string key = line.substr(at + 11, line.find('"', at + 11) - at - 11);
    EXPECT_NE(text.find("<key id=\"" + key + "\""), std::string::npos) << key;
  }
}

// Rows by number, parents before children, one root for each piece: where E is greatest.
TEST(CurveGraph, IsTreesInSwc) {
  std::istringstream lines(written(FileFormat::kSwc));
  std::vector<double> roots;
  int rows = 0;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with('#')) continue;
    std::istringstream row(line);
    int id = 0, type = -1, parent = 0;
    double x = 0, y = 0, z = 0, radius = 0;
    ASSERT_TRUE(row >> id >> type >> x >> y >> z >> radius >> parent) << line;
    EXPECT_EQ(id, ++rows);
    EXPECT_EQ(type, 0);
    EXPECT_GT(radius, 0);
    if (parent == -1) {
      roots.push_back(x);
    } else {
      EXPECT_GE(parent, 1);
      EXPECT_LT(parent, id);
    }
  }
  EXPECT_EQ(rows, 9);
  EXPECT_EQ(roots, (std::vector<double>{2, 5, 9}));
}

}  // namespace
}  // namespace affskel::client

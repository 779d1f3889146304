// A curve skeleton as a graph, in JSON and in GraphML (Brandes, Eiglsperger, Lerner and Pich, 2013).
#include <algorithm>
#include <cstddef>
#include <nlohmann/json.hpp>

#include "base/number_text.h"
#include "client/files/write/curve_graph.h"
#include "client/files/write/shape_writers.h"
#include "client/text/printable.h"
#include "core/mesh/polylines.h"

namespace affskel::client {
namespace {

using nlohmann::ordered_json;

std::string xml_text(std::string_view text) {
  std::string result;
  for (const char c : one_line(text)) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result.push_back(c);
    }
  }
  return result;
}

ordered_json vertex_of(const ShapeFile& shape, std::uint32_t v) {
  const core::Vec3& at = shape.mesh().points[v];
  ordered_json vertex{{"place", {at.x, at.y, at.z}}};
  for (const char* name : {"E", "radius", "distance"}) vertex[name] = curve_column(shape, name)[v];
  return vertex;
}

class GraphMl {
 public:
  explicit GraphMl(const WriteBytes& write) : write_(write) {}

  void key(const char* of, const char* name, const char* type) {
    write_(std::string("  <key id=\"") + of + "_" + name + "\" for=\"" + of + "\" attr.name=\"" + name +
           "\" attr.type=\"" + type + "\"/>\n");
  }
  void data(const char* of, const char* name, const std::string& value) {
    write_(std::string("      <data key=\"") + of + "_" + name + "\">" + value + "</data>\n");
  }
  void data(const char* of, const char* name, double value) { data(of, name, base::to_text(value)); }

 private:
  const WriteBytes& write_;
};

std::string polyline_text(const ShapeFile& shape, const core::CurveBranch& branch) {
  std::string text;
  for (const std::uint32_t v : branch.vertices) {
    const core::Vec3& at = shape.mesh().points[v];
    text += (text.empty() ? "" : "; ") + base::to_text(at.x) + " " + base::to_text(at.y) + " " +
            base::to_text(at.z);
  }
  return text;
}

// Per node: the branch that is a body there, or a solid without limbs; else none.
std::vector<const core::CurveBranch*> bodies_of(const core::CurveGraph& graph) {
  std::vector<const core::CurveBranch*> bodies(graph.nodes.size(), nullptr);
  for (const core::CurveBranch& branch : graph.branches)
    if (branch.kind == core::BranchKind::kPoint && branch.share > 0) bodies[branch.from] = &branch;
  return bodies;
}

// How much of a branch's line runs within the bodies that it hangs on.
double length_in_bodies(const ShapeFile& shape, const core::CurveBranch& branch) {
  return std::max(0.0, core::length_of(shape.mesh().points, branch.vertices) - branch.length);
}

}  // namespace

void write_curve_json(const ShapeFile& shape, const std::vector<std::string>& comments,
                      const WriteBytes& write) {
  const core::CurveGraph graph = curve_graph(shape);
  ordered_json file{{"about", ordered_json::array()},
                    {"nodes", ordered_json::array()},
                    {"branches", ordered_json::array()}};
  for (const std::string& comment : comments) file["about"].push_back(one_line(comment));
  const auto bodies = bodies_of(graph);
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    ordered_json node = vertex_of(shape, graph.nodes[n]);
    node["degree"] = graph.degree[n];
    if (bodies[n] != nullptr) {
      node["part"] = bodies[n] - graph.branches.data() + 1;
      node["volume_share"] = bodies[n]->share;
    }
    file["nodes"].push_back(std::move(node));
  }
  for (std::size_t b = 0; b < graph.branches.size(); ++b) {
    const core::CurveBranch& branch = graph.branches[b];
    if (branch.kind == core::BranchKind::kPoint) continue;
    ordered_json line = ordered_json::array();
    for (const std::uint32_t v : branch.vertices) line.push_back(vertex_of(shape, v));
    const ordered_json part = branch.share > 0 ? ordered_json(b + 1) : ordered_json(nullptr);
    file["branches"].push_back({{"part", part},
                                {"nodes", {branch.from, branch.to}},
                                {"length", branch.length},
                                {"straight_length", branch.straight_length},
                                {"length_in_bodies", length_in_bodies(shape, branch)},
                                {"volume_share", branch.share},
                                {"mean_radius", branch.mean_radius},
                                {"least_radius", branch.least_radius},
                                {"greatest_radius", branch.greatest_radius},
                                {"vertices", std::move(line)}});
  }
  write(file.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n");
}

void write_curve_graphml(const ShapeFile& shape, const std::vector<std::string>& comments,
                         const WriteBytes& write) {
  const core::CurveGraph graph = curve_graph(shape);
  GraphMl xml(write);
  write(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<graphml xmlns=\"http://graphml.graphdrawing.org/xmlns\">\n");
  for (const char* name : {"x", "y", "z", "E", "radius", "distance", "volume_share"})
    xml.key("node", name, "double");
  xml.key("node", "degree", "int");
  for (const char* of : {"node", "edge"}) xml.key(of, "part", "int");
  for (const char* name : {"length", "straight_length", "length_in_bodies", "volume_share", "mean_radius",
                           "least_radius", "greatest_radius"})
    xml.key("edge", name, "double");
  xml.key("edge", "polyline", "string");
  write("  <graph edgedefault=\"undirected\">\n    <desc>");
  for (const std::string& comment : comments) write(xml_text(comment) + "\n");
  write("</desc>\n");
  const auto bodies = bodies_of(graph);
  for (std::size_t n = 0; n < graph.nodes.size(); ++n) {
    const core::Vec3& at = shape.mesh().points[graph.nodes[n]];
    write("    <node id=\"n" + std::to_string(n) + "\">\n");
    xml.data("node", "x", at.x);
    xml.data("node", "y", at.y);
    xml.data("node", "z", at.z);
    for (const char* name : {"E", "radius", "distance"})
      xml.data("node", name, curve_column(shape, name)[graph.nodes[n]]);
    xml.data("node", "degree", std::to_string(graph.degree[n]));
    if (bodies[n] != nullptr) {
      xml.data("node", "part", std::to_string(bodies[n] - graph.branches.data() + 1));
      xml.data("node", "volume_share", bodies[n]->share);
    }
    write("    </node>\n");
  }
  for (std::size_t b = 0; b < graph.branches.size(); ++b) {
    const core::CurveBranch& branch = graph.branches[b];
    if (branch.kind == core::BranchKind::kPoint) continue;
    write("    <edge id=\"b" + std::to_string(b) + "\" source=\"n" + std::to_string(branch.from) +
          "\" target=\"n" + std::to_string(branch.to) + "\">\n");
    if (branch.share > 0) xml.data("edge", "part", std::to_string(b + 1));
    xml.data("edge", "length", branch.length);
    xml.data("edge", "straight_length", branch.straight_length);
    xml.data("edge", "length_in_bodies", length_in_bodies(shape, branch));
    xml.data("edge", "volume_share", branch.share);
    xml.data("edge", "mean_radius", branch.mean_radius);
    xml.data("edge", "least_radius", branch.least_radius);
    xml.data("edge", "greatest_radius", branch.greatest_radius);
    xml.data("edge", "polyline", polyline_text(shape, branch));
    write("    </edge>\n");
  }
  write("  </graph>\n</graphml>\n");
}

}  // namespace affskel::client

#include "client/files/write/curve_graph.h"

#include <algorithm>
#include <string>

#include "client/base/error.h"
#include "core/mesh/polylines.h"

namespace affskel::client {
namespace {

CurveBranch branch_of(const ShapeFile& shape, const std::vector<double>& radius,
                      std::vector<std::uint32_t> vertices) {
  const auto& points = shape.mesh().points;
  CurveBranch branch;
  double sum = 0;
  branch.least_radius = branch.greatest_radius = radius[vertices.front()];
  for (std::size_t n = 1; n < vertices.size(); ++n) {
    const std::uint32_t a = vertices[n - 1], b = vertices[n];
    const double length = core::norm(points[b] - points[a]);
    branch.length += length;
    sum += 0.5 * length * (radius[a] + radius[b]);
    branch.least_radius = std::min(branch.least_radius, radius[b]);
    branch.greatest_radius = std::max(branch.greatest_radius, radius[b]);
  }
  branch.mean_radius = branch.length > 0 ? sum / branch.length : branch.least_radius;
  branch.straight_length = core::norm(points[vertices.back()] - points[vertices.front()]);
  branch.vertices = std::move(vertices);
  return branch;
}

}  // namespace

const std::vector<double>& curve_column(const ShapeFile& shape, const char* name) {
  const PointColumn* column = shape.column(name);
  if (column == nullptr)
    throw ClientError(ExitCode::kInternal, std::string("the curve has no ") + name + " at its vertices");
  return column->values;
}

CurveGraph curve_graph(const ShapeFile& shape) {
  const std::size_t vertices = shape.mesh().points.size();
  const std::vector<double>& share = curve_column(shape, "share");
  CurveGraph graph;
  std::vector<std::uint32_t> ends(vertices, 0);  // of branches at each vertex
  for (auto& line : core::polylines(vertices, shape.segments)) {
    ++ends[line.front()];
    ++ends[line.back()];
    graph.branches.push_back(branch_of(shape, curve_column(shape, "radius"), std::move(line)));
  }
  std::vector<char> within(vertices, 0);
  for (const CurveBranch& branch : graph.branches)
    for (std::size_t n = 1; n + 1 < branch.vertices.size(); ++n) within[branch.vertices[n]] = 1;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (within[v]) continue;
    graph.nodes.push_back(v);
    graph.degree.push_back(ends[v]);
  }
  const auto node = [&](std::uint32_t v) {
    return static_cast<std::uint32_t>(std::lower_bound(graph.nodes.begin(), graph.nodes.end(), v) -
                                      graph.nodes.begin());
  };
  for (CurveBranch& branch : graph.branches) {
    branch.from = node(branch.vertices.front());
    branch.to = node(branch.vertices.back());
    for (std::size_t n = 1; n + 1 < branch.vertices.size(); ++n) branch.share += share[branch.vertices[n]];
    for (const std::uint32_t v : {branch.vertices.front(), branch.vertices.back()})
      branch.share += share[v] / ends[v];
  }
  return graph;
}

}  // namespace affskel::client
